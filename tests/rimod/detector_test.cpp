#include "rimod/detector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "rimod/feature_extraction.h"
#include "rimod/model_building.h"
#include "rimod/model_database.h"
#include "tests/io/random_values.h"
#include "tests/support/executions.h"
#include "tests/support/furniture.h"
#include "tests/support/matchers.h"
#include "tests/support/ray_caster.h"

namespace rimod {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr Method kMethods[] = {Method::kPaper, Method::kDefault};

// --- a room with them ------------------------------------------------------------------------

const Eigen::Isometry3d kSensor = Placed(0.0, 0.0, 1.1, 0.0);
const Eigen::Isometry3d kFirstArmchair = Placed(2.2, 0.75, 0.0, 200 * kDegree);
const Eigen::Isometry3d kSecondArmchair = Placed(2.7, -0.7, 0.0, 125 * kDegree);

BeamPattern RoomPattern() {
  BeamPattern pattern;
  pattern.azimuth_min = -0.9;
  pattern.azimuth_max = 0.9;
  pattern.elevation_min = -0.8;
  pattern.elevation_max = 0.4;
  pattern.step = 0.0065;
  pattern.noise = 0.004;
  return pattern;
}

// Floor, walls, a cupboard and a ball; with the two armchairs or without.
World Room(bool with_armchairs) {
  World world;
  world.planes = {{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()},
                  {Eigen::Vector3d(4.5, 0, 0), -Eigen::Vector3d::UnitX()},
                  {Eigen::Vector3d(0, 2.5, 0), -Eigen::Vector3d::UnitY()},
                  {Eigen::Vector3d(0, -2.5, 0), Eigen::Vector3d::UnitY()}};
  BoxShape cupboard;
  cupboard.T_local_box = Placed(4.2, 0.4, 0.9, 0.0);
  cupboard.half_size = Eigen::Vector3d(0.25, 0.5, 0.9);
  world.boxes = {cupboard};
  world.spheres = {{Eigen::Vector3d(3.4, 1.7, 0.25), 0.25}};
  if (with_armchairs) {
    Place(Armchair(), kFirstArmchair, &world);
    Place(Armchair(), kSecondArmchair, &world);
  }
  return world;
}

DetectionResult Detect(const Scan& scan, const ModelDatabase& database,
                       const PipelineParams& params, const Execution& execution = {}) {
  const RangeImage image = ComputeRangeImage(scan, params, execution);
  const FeatureSet features = ExtractFeatures(image, params, execution);
  return DetectObjects(image, features, database, params, execution);
}

// Few views, pixels and candidates, so that the tests are quick.
PipelineParams QuickParams(Method method) {
  PipelineParams params = DefaultParams(method);
  params.range_image.resolution = 0.01;
  params.matching.max_matches = 8;
  params.ranking.refined = {10, 150, 0.001};
  params.ranking.judged = {10, 40, 0.001};
  params.model_views.azimuths = 8;
  params.model_views.elevations = 1;
  params.model_views.min_elevation = 0.25;
  params.model_views.max_elevation = 0.25;
  return params;
}

const std::vector<ObjectModel>& QuickModels(Method method) {
  const auto make = [](Method m) -> std::vector<ObjectModel> {
    return {BuildModel(Record(Armchair()), QuickParams(m), Execution{}),
            BuildModel(Record(Stool()), QuickParams(m), Execution{})};
  };
  static const std::vector<ObjectModel> paper = make(Method::kPaper);
  static const std::vector<ObjectModel> other = make(Method::kDefault);
  return method == Method::kPaper ? paper : other;
}

ModelDatabase QuickDatabase(Method method) {
  return ModelDatabase(QuickModels(method), QuickParams(method), Execution{});
}

Scan RoomScan(bool with_armchairs) {
  static const Scan furnished = ScanWorld(Room(true), kSensor, RoomPattern());
  static const Scan empty = ScanWorld(Room(false), kSensor, RoomPattern());
  return with_armchairs ? furnished : empty;
}

void ExpectSame(const DetectionResult& a, const DetectionResult& b) {
  EXPECT_EQ(a.num_hypotheses_found, b.num_hypotheses_found);
  ASSERT_EQ(a.hypotheses.size(), b.hypotheses.size());
  for (std::size_t i = 0; i < a.hypotheses.size(); ++i) {
    EXPECT_EQ(a.hypotheses[i].class_name, b.hypotheses[i].class_name);
    EXPECT_EQ(a.hypotheses[i].T_local_object.matrix(), b.hypotheses[i].T_local_object.matrix());
    EXPECT_EQ(a.hypotheses[i].score, b.hypotheses[i].score);
    EXPECT_EQ(a.hypotheses[i].stage, b.hypotheses[i].stage);
  }
  ASSERT_EQ(a.detections.size(), b.detections.size());
  for (std::size_t i = 0; i < a.detections.size(); ++i) {
    EXPECT_EQ(a.detections[i].class_name, b.detections[i].class_name);
    EXPECT_EQ(a.detections[i].T_local_object.matrix(), b.detections[i].T_local_object.matrix());
    EXPECT_EQ(a.detections[i].score, b.detections[i].score);
  }
}

// What holds of every result.
void ExpectSound(const DetectionResult& result, const PipelineParams& params) {
  EXPECT_LE(static_cast<int>(result.hypotheses.size()), params.max_reported_hypotheses);
  EXPECT_GE(result.num_hypotheses_found, 0);
  for (const PoseHypothesis& hypothesis : result.hypotheses) {
    EXPECT_TRUE(hypothesis.T_local_object.matrix().allFinite());
    EXPECT_TRUE(hypothesis.score >= 0.0 && hypothesis.score <= 1.0) << hypothesis.score;
  }
  double before = 1.0;
  for (const Detection& detection : result.detections) {
    EXPECT_TRUE(detection.T_local_object.matrix().allFinite());
    EXPECT_NEAR(detection.T_local_object.linear().determinant(), 1.0, 1e-6);
    EXPECT_LE(detection.score, before);
    EXPECT_GE(detection.score, 0.0);
    before = detection.score;
  }
}

bool HasDetectionAt(const DetectionResult& result, const std::string& class_name,
                    const Eigen::Isometry3d& T_local_object) {
  return std::any_of(result.detections.begin(), result.detections.end(), [&](const Detection& d) {
    return d.class_name == class_name &&
           PosesNear(d.T_local_object, T_local_object, 0.05, 5 * kDegree);
  });
}

// --- finding ---------------------------------------------------------------------------------

TEST(DetectObjectsTest, FindsTwoOfAKindWhereTheyStand) {
  const PipelineParams params = DefaultParams(Method::kDefault);
  const ModelDatabase database({BuildModel(Record(Armchair()), params, Execution{}),
                                BuildModel(Record(Stool()), params, Execution{})},
                               params, Execution{});
  const DetectionResult result = Detect(RoomScan(true), database, params, OnThreads(2));
  ExpectSound(result, params);
  EXPECT_TRUE(HasDetectionAt(result, "armchair", kFirstArmchair));
  EXPECT_TRUE(HasDetectionAt(result, "armchair", kSecondArmchair));
  EXPECT_EQ(result.detections.size(), 2u);
  for (const Detection& detection : result.detections) {
    EXPECT_EQ(detection.box_min, database.models()[0].box_min);
    EXPECT_EQ(detection.box_max, database.models()[0].box_max);
  }
}

TEST(DetectObjectsTest, FindsNothingInAnEmptyRoom) {
  const PipelineParams params = QuickParams(Method::kDefault);
  const DetectionResult result = Detect(RoomScan(false), QuickDatabase(Method::kDefault), params);
  ExpectSound(result, params);
  EXPECT_TRUE(result.detections.empty());
}

TEST(DetectObjectsTest, AMovedSceneGivesMovedPoses) {
  const PipelineParams params = QuickParams(Method::kDefault);
  const ModelDatabase database = QuickDatabase(Method::kDefault);
  const Scan scan = RoomScan(true);
  const Eigen::Isometry3d T_moved_local = Placed(8.0, -3.0, 0.5, 2.0);
  Scan moved;
  moved.T_local_sensor = T_moved_local * scan.T_local_sensor;
  for (const Eigen::Vector3f& p : scan.points)
    moved.points.push_back((T_moved_local * p.cast<double>()).cast<float>());
  const DetectionResult before = Detect(scan, database, params, OnThreads(2));
  const DetectionResult after = Detect(moved, database, params, OnThreads(2));
  for (const Eigen::Isometry3d& pose : {kFirstArmchair, kSecondArmchair}) {
    EXPECT_TRUE(HasDetectionAt(before, "armchair", pose));
    EXPECT_TRUE(HasDetectionAt(after, "armchair", T_moved_local * pose));
  }
}

// --- the same every time ---------------------------------------------------------------------

TEST(DetectObjectsTest, ThreadsAndOrderOfModelsDoNotMatter) {
  const Scan scan = RoomScan(true);
  for (const Method method : kMethods) {
    const PipelineParams params = QuickParams(method);
    const std::vector<ObjectModel>& models = QuickModels(method);
    const ModelDatabase one = QuickDatabase(method);
    const ModelDatabase two({models[1], models[0]}, params, OnThreads(4));
    const DetectionResult result = Detect(scan, one, params);
    ExpectSound(result, params);
    EXPECT_FALSE(result.hypotheses.empty());
    ExpectSame(Detect(scan, one, params, OnThreads(4)), result);
    ExpectSame(Detect(scan, two, params, Backwards()), result);
  }
}

// --- stages ----------------------------------------------------------------------------------

TEST(DetectObjectsTest, StagesDoNotNestAndTheKnownOnesAreTold) {
  for (const Method method : kMethods) {
    const PipelineParams params = QuickParams(method);
    std::vector<std::string> stages;
    int open = 0;
    Execution execution;
    execution.on_stage_begin = [&](const std::string& stage) {
      EXPECT_EQ(++open, 1) << stage;
      stages.push_back(stage);
    };
    execution.on_stage_end = [&](const std::string& stage) {
      EXPECT_EQ(--open, 0);
      EXPECT_EQ(stage, stages.back());
    };
    Detect(RoomScan(true), QuickDatabase(method), params, execution);
    for (const char* stage : {"range_image", "interest_points", "descriptors", "matching",
                              "hypotheses", "scoring", "collisions", "validation"})
      EXPECT_EQ(std::count(stages.begin(), stages.end(), stage), 1) << stage;
  }
}

TEST(DetectObjectsTest, ReportsNoMoreHypothesesThanAllowed) {
  const Scan scan = RoomScan(true);
  for (const Method method : kMethods) {
    PipelineParams params = QuickParams(method);
    const ModelDatabase database = QuickDatabase(method);
    const DetectionResult many = Detect(scan, database, params);
    params.max_reported_hypotheses = 3;
    const DetectionResult few = Detect(scan, database, params);
    EXPECT_LE(few.hypotheses.size(), 3u);
    EXPECT_EQ(few.num_hypotheses_found, many.num_hypotheses_found);
    EXPECT_EQ(few.detections.size(), many.detections.size());
    for (std::size_t i = 0; i < few.hypotheses.size(); ++i)
      EXPECT_EQ(few.hypotheses[i].T_local_object.matrix(),
                many.hypotheses[i].T_local_object.matrix());
  }
}

// --- what is hardly a scan -------------------------------------------------------------------

TEST(DetectObjectsTest, DegenerateScansHaveNoObjects) {
  Scan empty;
  Scan one = empty, duplicates = empty, line = empty, no_returns = empty, plane = empty;
  one.points = {{2.0f, 0.0f, 0.0f}};
  duplicates.points.assign(5000, {2.0f, 0.3f, 0.1f});
  for (int i = 0; i < 2000; ++i)
    line.points.push_back({2.0f, 0.001f * static_cast<float>(i), 0.0f});
  World nothing;
  no_returns = ScanWorld(nothing, Eigen::Isometry3d::Identity(), BeamPattern{});
  World wall;
  wall.planes = {{Eigen::Vector3d(3, 0, 0), -Eigen::Vector3d::UnitX()}};
  plane = ScanWorld(wall, Eigen::Isometry3d::Identity(), BeamPattern{});
  for (const Method method : kMethods) {
    const PipelineParams params = QuickParams(method);
    const ModelDatabase database = QuickDatabase(method);
    for (const Scan* scan : {&empty, &one, &duplicates, &line, &no_returns, &plane}) {
      const DetectionResult result = Detect(*scan, database, params);
      ExpectSound(result, params);
      EXPECT_TRUE(result.detections.empty());
    }
  }
}

TEST(DetectObjectsTest, RandomPointsAreHarmless) {
  RandomValues random(1);
  Scan scan = random.AScan(20000, 2000);
  for (const Method method : kMethods) {
    const PipelineParams params = QuickParams(method);
    ExpectSound(Detect(scan, QuickDatabase(method), params), params);
  }
}

TEST(DetectObjectsTest, NoModelsFindNothing) {
  for (const Method method : kMethods) {
    const PipelineParams params = QuickParams(method);
    const ModelDatabase database({}, params, Execution{});
    const DetectionResult result = Detect(RoomScan(true), database, params);
    EXPECT_EQ(result.num_hypotheses_found, 0);
    EXPECT_TRUE(result.hypotheses.empty() && result.detections.empty());
  }
}

TEST(DetectObjectsTest, RefusesADatabaseOfAnotherMethod) {
  const PipelineParams paper = QuickParams(Method::kPaper), other = QuickParams(Method::kDefault);
  FeatureSet features;
  features.descriptor_kind = other.range_patch.Kind();
  EXPECT_TRUE(Complains(
      [&] {
        DetectObjects(RangeImage(), features, ModelDatabase({}, paper, Execution{}), other,
                      Execution{});
      },
      {"method"}));
}

TEST(DetectObjectsTest, RefusesFeaturesOfAnotherKind) {
  for (const Method method : kMethods) {
    const PipelineParams params = QuickParams(method);
    FeatureSet features;
    features.descriptor_kind = "spin images";
    EXPECT_TRUE(Complains(
        [&] {
          DetectObjects(RangeImage(), features, ModelDatabase({}, params, Execution{}), params,
                        Execution{});
        },
        {"spin images"}));
  }
}

}  // namespace
}  // namespace rimod
