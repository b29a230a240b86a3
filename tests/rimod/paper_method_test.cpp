#include "rimod/paper_method.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "rimod/feature_extraction.h"
#include "rimod/model_building.h"
#include "tests/support/executions.h"
#include "tests/support/furniture.h"
#include "tests/support/matchers.h"

namespace rimod {
namespace {

// Settings of our own, so that tuning the method's does not touch these tests.
PipelineParams Params() {
  PipelineParams params;
  params.method = Method::kPaper;
  params.range_image.resolution = 0.007;
  params.interest_points.measure = InterestMeasure::kSurfaceChange;
  params.interest_points.max_points = 600;
  params.interest_points.suppression_radius = 0.05;
  params.range_patch.resolution = 8;
  params.range_patch.support_size = 0.35;
  params.range_patch.normal_radius = 0.08;
  params.model_views.azimuths = 12;
  params.model_views.elevations = 1;
  params.model_views.min_elevation = 0.3;
  params.model_views.max_elevation = 0.3;
  params.model_views.distance = 2.3;
  params.matching.max_descriptor_distance = 0.05;
  params.matching.max_matches = 40;
  params.matching.max_checks = 1000;
  params.matching.min_shared_cells = 24;
  params.matching.min_roughness = 0.01;
  params.goodsac.max_correspondences = 1500;
  params.goodsac.min_model_spacing = 0.05;
  params.goodsac.max_trials = 5000;
  params.goodsac.min_separation = 0.15;
  params.goodsac.distance_tolerance = 0.04;
  params.goodsac.max_tilt = 0.2;
  params.goodsac.angle_tolerance = 0.4;
  params.goodsac.height_tolerance = 0.04;
  params.goodsac.max_poses_a_correspondence = 5;
  params.scoring.epsilon = 0.1;
  params.scoring.penalty = 1.0;
  params.scoring.window = 1;
  params.scoring.gamma = 0.3;
  params.pruning.radius = 0.3;
  params.collisions.max_share = 0.15;
  params.pose_refinement.iterations = 0;
  params.validation.scoring = params.scoring;
  params.validation.min_score = 0.5;
  params.validation.before_collisions = true;
  return params;
}

const Eigen::Isometry3d kPose = Placed(2.2, 0.3, -1.0, 2.0);

// A sculpture alone in the dark.
const RangeImage& SculptureImage() {
  static const RangeImage image = [] {
    World world;
    Place(Sculpture(), kPose, &world);
    return MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{}),
                          Params().range_image);
  }();
  return image;
}

const ModelDatabase& SculptureDatabase() {
  static const ModelDatabase database({BuildModel(Record(Sculpture()), Params(), Execution{})},
                                      Params(), Execution{});
  return database;
}

StagedCandidates Find(const PipelineParams& params, const Execution& execution = {}) {
  return FindByTriples(SculptureImage(), ExtractFeatures(SculptureImage(), params, execution),
                       SculptureDatabase(), params, execution);
}

bool Holds(const std::vector<Candidate>& list, const Candidate& candidate) {
  return std::any_of(list.begin(), list.end(), [&](const Candidate& other) {
    return other.T_sensor_object.matrix() == candidate.T_sensor_object.matrix();
  });
}

TEST(FindByTriplesTest, FindsAnObjectWhereItStands) {
  const StagedCandidates found = Find(Params());
  ASSERT_EQ(found.validated.size(), 1u);
  EXPECT_TRUE(PosesNear(found.validated[0].T_sensor_object, kPose, 0.1, 0.2));
  EXPECT_GT(found.validated[0].score, 0.6);
}

TEST(FindByTriplesTest, FindsItInPinholeImagesOfCamerasThatLookDown) {
  for (const double pitch : {0.25, 0.8, 1.2}) {
    const Eigen::Isometry3d pose =
        Placed(2.4 * std::cos(pitch), 0.1, -2.4 * std::sin(pitch) - 0.4, 2.0);
    World world;
    Place(Sculpture(), pose, &world);
    CameraPattern camera;
    camera.pitch = pitch;
    PipelineParams params = Params();
    params.range_image.projection = Projection::kPinhole;
    const RangeImage image =
        MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), camera), params.range_image);
    ASSERT_EQ(image.grid().projection, Projection::kPinhole);
    const StagedCandidates found = FindByTriples(image, ExtractFeatures(image, params, Execution{}),
                                                 SculptureDatabase(), params, Execution{});
    ASSERT_EQ(found.validated.size(), 1u) << pitch;
    EXPECT_TRUE(PosesNear(found.validated[0].T_sensor_object, pose, 0.1, 0.2)) << pitch;
  }
}

// Triples need the features' positions alone: what describes them may be exchanged.
TEST(FindByTriplesTest, FindsItBySphericalSpinImages) {
  for (const int dimensions : {0, 20}) {
    PipelineParams params = Params();
    params.descriptor = DescriptorType::kSphericalSpin;
    params.spherical_spin.resolution = 8;
    params.spherical_spin.support_size = 0.5;
    params.spherical_spin.dimensions = dimensions;
    const ModelDatabase database({SculptureDatabase().models()[0]}, params, Execution{});
    EXPECT_NE(database.descriptor_kind(), SculptureDatabase().descriptor_kind());
    const StagedCandidates found =
        FindByTriples(SculptureImage(), ExtractFeatures(SculptureImage(), params, Execution{}),
                      database, params, Execution{});
    ASSERT_FALSE(found.validated.empty()) << dimensions;
    EXPECT_TRUE(PosesNear(found.validated[0].T_sensor_object, kPose, 0.1, 0.2)) << dimensions;
  }
}

TEST(FindByTriplesTest, RefinementComesNearerToThePose) {
  PipelineParams params = Params();
  params.pose_refinement.iterations = 10;
  params.pose_refinement.first_gate = 0.15;
  params.pose_refinement.last_gate = 0.05;
  params.pose_refinement.damping = 0.02;
  params.pose_refinement.normal_radius = 0.1;
  const StagedCandidates found = Find(params);
  ASSERT_EQ(found.validated.size(), 1u);
  EXPECT_TRUE(PosesNear(found.validated[0].T_sensor_object, kPose, 0.03, 0.05));
}

TEST(FindByTriplesTest, EachStageKeepsSomeOfTheOneBefore) {
  PipelineParams params = Params();
  for (const bool validation_first : {false, true}) {
    params.validation.before_collisions = validation_first;
    const StagedCandidates found = Find(params);
    EXPECT_EQ(found.num_found, static_cast<int>(found.scored.size()));
    EXPECT_LT(found.pruned.size(), found.scored.size());
    EXPECT_LE(found.collision_free.size(), found.pruned.size());
    EXPECT_LE(found.validated.size(), found.collision_free.size());
    for (const Candidate& candidate : found.pruned) EXPECT_TRUE(Holds(found.scored, candidate));
    for (const Candidate& candidate : found.validated) EXPECT_TRUE(Holds(found.pruned, candidate));
    for (const Candidate& candidate : found.scored)
      EXPECT_GE(candidate.score, params.scoring.gamma);
    for (const Candidate& candidate : found.validated)
      EXPECT_GE(candidate.score, params.validation.min_score);
  }
}

TEST(FindByTriplesTest, ThreadsDoNotMatter) {
  const StagedCandidates alone = Find(Params()), other = Find(Params(), OnThreads(4));
  ASSERT_EQ(alone.scored.size(), other.scored.size());
  for (std::size_t i = 0; i < alone.scored.size(); ++i) {
    EXPECT_EQ(alone.scored[i].T_sensor_object.matrix(), other.scored[i].T_sensor_object.matrix());
    EXPECT_EQ(alone.scored[i].score, other.scored[i].score);
  }
  ASSERT_EQ(alone.validated.size(), other.validated.size());
}

}  // namespace
}  // namespace rimod
