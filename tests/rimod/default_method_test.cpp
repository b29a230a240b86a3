#include "rimod/default_method.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "rimod/feature_extraction.h"
#include "rimod/model_building.h"
#include "tests/support/executions.h"
#include "tests/support/furniture.h"
#include "tests/support/matchers.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

PipelineParams Params() {
  PipelineParams params = DefaultParams(Method::kDefault);
  params.range_image.resolution = 0.01;
  params.model_views.azimuths = 8;
  params.model_views.elevations = 1;
  params.ranking.max_refined = 200;
  params.ranking.max_judged = 60;
  return params;
}

// --- choosing ----------------------------------------------------------------------------------

ChoiceParams Choice() {
  ChoiceParams choice;
  choice.min_probability = 0.5;
  choice.max_explained_share = 0.4;
  choice.same_class_distance = 0.4;
  choice.other_class_distance = 0.2;
  return choice;
}

class ChooseCandidatesTest : public testing::Test {
 protected:
  ChooseCandidatesTest()
      : image_(Grid(), Eigen::Isometry3d::Identity()),
        scene_(image_, 0.1, Execution{}),
        database_({BoxModel("a", {0.6, 0.6, 0.6}, 0.05), BoxModel("b", {0.6, 0.6, 0.6}, 0.05)},
                  Params(), Execution{}) {}

  static SphericalGrid Grid() {
    SphericalGrid grid;
    grid.width = 100;
    grid.height = 10;
    grid.resolution = 0.01;
    return grid;
  }

  // Far from all others unless x says otherwise; explains the pixels [first, last).
  static JudgedCandidate Judged(double score, int first, int last, double x, int model = 0) {
    JudgedCandidate judged;
    judged.candidate = {model, Placed(x, 0.0, 0.0, 0.0), score};
    judged.evidence.explained.resize(last - first);
    std::iota(judged.evidence.explained.begin(), judged.evidence.explained.end(), first);
    return judged;
  }

  std::vector<double> ChosenScores(const std::vector<JudgedCandidate>& judged) const {
    PipelineParams params = Params();
    params.choice = Choice();
    std::vector<double> scores;
    for (const Candidate& candidate :
         ChooseCandidates(scene_, judged, database_, params, Execution{}))
      scores.push_back(candidate.score);
    return scores;
  }

  RangeImage image_;
  Scene scene_;
  ModelDatabase database_;
};

using Scores = std::vector<double>;

TEST_F(ChooseCandidatesTest, ImprobableOnesAreLeftOut) {
  EXPECT_EQ(
      ChosenScores({Judged(0.9, 0, 100, 2), Judged(0.51, 100, 200, 4), Judged(0.49, 200, 300, 6)}),
      (Scores{0.9, 0.51}));
  EXPECT_TRUE(ChosenScores({}).empty());
}

TEST_F(ChooseCandidatesTest, EachPixelIsExplainedOnce) {
  // The second shares half of its pixels with the first, the third a quarter.
  EXPECT_EQ(
      ChosenScores({Judged(0.9, 0, 100, 2), Judged(0.8, 50, 150, 4), Judged(0.7, 75, 175, 6)}),
      (Scores{0.9, 0.7}));
}

TEST_F(ChooseCandidatesTest, WhatExplainsNothingIsLeftOut) {
  EXPECT_TRUE(ChosenScores({Judged(0.9, 0, 0, 2)}).empty());
}

TEST_F(ChooseCandidatesTest, CentresKeepTheirDistance) {
  // The diameter is 1.04 m: 0.42 m between two of a class, 0.21 m between two classes.
  EXPECT_EQ(ChosenScores({Judged(0.9, 0, 10, 2.0), Judged(0.8, 10, 20, 2.3)}), (Scores{0.9}));
  EXPECT_EQ(ChosenScores({Judged(0.9, 0, 10, 2.0), Judged(0.8, 10, 20, 2.5)}), (Scores{0.9, 0.8}));
  EXPECT_EQ(ChosenScores({Judged(0.9, 0, 10, 2.0), Judged(0.8, 10, 20, 2.3, 1)}),
            (Scores{0.9, 0.8}));
  EXPECT_EQ(ChosenScores({Judged(0.9, 0, 10, 2.0), Judged(0.8, 10, 20, 2.1, 1)}), (Scores{0.9}));
}

// --- finding -----------------------------------------------------------------------------------

const Eigen::Isometry3d kPose = Placed(2.2, 0.3, -1.1, 2.0);

// An armchair on a floor before a wall.
RangeImage ArmchairImage() {
  World world;
  world.planes = {{Eigen::Vector3d(0, 0, -1.1), Eigen::Vector3d::UnitZ()},
                  {Eigen::Vector3d(4, 0, 0), -Eigen::Vector3d::UnitX()}};
  Place(Armchair(), kPose, &world);
  return MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{}),
                        Params().range_image);
}

const ModelDatabase& ArmchairDatabase() {
  static const ModelDatabase database({BuildModel(Record(Armchair()), Params(), Execution{})},
                                      Params(), Execution{});
  return database;
}

TEST(RankCandidatesTest, TheTruePoseIsAmongThem) {
  const RangeImage image = ArmchairImage();
  const Scene scene(image, Params().evidence.normal_radius, Execution{});
  const FeatureSet features = ExtractFeatures(image, Params(), Execution{});
  int num_found = 0;
  const std::vector<RankedCandidate> ranked =
      RankCandidates(scene, features, ArmchairDatabase(), Params(), Execution{}, &num_found);
  EXPECT_GE(num_found, static_cast<int>(ranked.size()));
  EXPECT_LE(static_cast<int>(ranked.size()), Params().ranking.max_judged);
  EXPECT_TRUE(std::any_of(ranked.begin(), ranked.end(), [](const RankedCandidate& r) {
    return PosesNear(r.candidate.T_sensor_object, kPose, 0.05, 0.1);
  }));
  for (std::size_t i = 1; i < ranked.size(); ++i)
    EXPECT_GE(ranked[i - 1].candidate.score, ranked[i].candidate.score);

  const std::vector<JudgedCandidate> judged =
      JudgeCandidates(scene, ranked, ArmchairDatabase(), Params(), Execution{});
  ASSERT_EQ(judged.size(), ranked.size());
  EXPECT_TRUE(std::any_of(judged.begin(), judged.end(), [](const JudgedCandidate& j) {
    return PosesNear(j.candidate.T_sensor_object, kPose, 0.02, 0.04) &&
           j.evidence.values[kMatchedOfKnown] > 0.8;
  }));
  for (std::size_t i = 1; i < judged.size(); ++i)
    EXPECT_GE(judged[i - 1].candidate.score, judged[i].candidate.score);
}

TEST(RankCandidatesTest, ThreadsDoNotMatter) {
  const RangeImage image = ArmchairImage();
  const Scene scene(image, Params().evidence.normal_radius, Execution{});
  const FeatureSet features = ExtractFeatures(image, Params(), Execution{});
  int num_alone = 0, num_other = 0;
  const auto alone =
      RankCandidates(scene, features, ArmchairDatabase(), Params(), Execution{}, &num_alone);
  const auto other =
      RankCandidates(scene, features, ArmchairDatabase(), Params(), OnThreads(4), &num_other);
  EXPECT_EQ(num_alone, num_other);
  ASSERT_EQ(alone.size(), other.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(alone[i].candidate.T_sensor_object.matrix(),
              other[i].candidate.T_sensor_object.matrix());
    EXPECT_EQ(alone[i].candidate.score, other[i].candidate.score);
  }
}

TEST(FindByEvidenceTest, TellsWhatItFoundStageByStage) {
  const RangeImage image = ArmchairImage();
  const FeatureSet features = ExtractFeatures(image, Params(), Execution{});
  const StagedCandidates found =
      FindByEvidence(image, features, ArmchairDatabase(), Params(), Execution{});
  EXPECT_GE(found.num_found, static_cast<int>(found.scored.size()));
  EXPECT_LE(found.validated.size(), found.scored.size());
  for (const Candidate& candidate : found.validated) {
    EXPECT_TRUE(std::any_of(found.scored.begin(), found.scored.end(), [&](const Candidate& s) {
      return s.T_sensor_object.matrix() == candidate.T_sensor_object.matrix();
    }));
  }
}

}  // namespace
}  // namespace rimod
