#include "viewer_tools/detector_trace.h"

#include <gtest/gtest.h>

#include "rimod/detector.h"
#include "rimod/model_building.h"
#include "tests/support/furniture.h"
#include "viewer_tools/report_cases.h"

namespace rimod {
namespace {

PipelineParams Params(Method method) {
  PipelineParams params = DefaultParams(method);
  params.range_image.resolution = 0.01;
  params.model_views.azimuths = 8;
  params.model_views.elevations = 1;
  return params;
}

// A sculpture and a stool on a floor before a wall.
class DetectorTraceTest : public testing::TestWithParam<Method> {
 protected:
  DetectorTraceTest()
      : params_(Params(GetParam())),
        database_({BuildModel(Record(Sculpture()), params_, Execution{}),
                   BuildModel(Record(Stool()), params_, Execution{})},
                  params_, Execution{}) {
    World world;
    world.planes.push_back({});
    world.planes.push_back({{5.0, 0.0, 0.0}, -Eigen::Vector3d::UnitX()});
    sculpture_.class_name = "sculpture";
    sculpture_.T_local_object = Placed(2.2, 0.4, 0.0, 0.7);
    Place(Sculpture(), sculpture_.T_local_object, &world);
    Place(Stool(), Placed(2.5, -0.5, 0.0, 2.0), &world);
    BeamPattern pattern;
    pattern.noise = 0.004;
    image_ = ComputeRangeImage(ScanWorld(world, Placed(0.0, 0.0, 1.0, 0.0), pattern), params_,
                               Execution{});
    for (const ObjectModel& model : database_.models())
      shapes_[model.name] = {model.box_min, model.box_max, Symmetry::kNone};
  }

  PipelineParams params_;
  ModelDatabase database_;
  RangeImage image_;
  ObjectShapes shapes_;
  LabelledObject sculpture_;
};

TEST_P(DetectorTraceTest, ChoosesWhatTheDetectorDetects) {
  const Scene scene(image_, params_.evidence.normal_radius, Execution{});
  const DetectorTrace trace = TraceDetector(scene, database_, params_, Execution{});
  const FeatureSet features = ExtractFeatures(image_, params_, Execution{});
  const std::vector<Detection> detections =
      DetectObjects(image_, features, database_, params_, Execution{}).detections;
  ASSERT_FALSE(detections.empty());
  ASSERT_EQ(trace.chosen.size(), detections.size());
  for (std::size_t i = 0; i < detections.size(); ++i) {
    EXPECT_EQ(trace.chosen[i].score, detections[i].score);
    EXPECT_EQ((image_.T_local_sensor() * trace.chosen[i].T_sensor_object).matrix(),
              detections[i].T_local_object.matrix());
  }
  EXPECT_EQ(trace.stages.back().candidates.size(), detections.size());
  for (std::size_t i = 1; i < trace.stages.size(); ++i)
    EXPECT_LE(trace.stages[i].candidates.size(), trace.stages[i - 1].candidates.size());
}

INSTANTIATE_TEST_SUITE_P(Methods, DetectorTraceTest,
                         testing::Values(Method::kDefault, Method::kPaper));

using DefaultMethodTraceTest = DetectorTraceTest;
INSTANTIATE_TEST_SUITE_P(Default, DefaultMethodTraceTest, testing::Values(Method::kDefault));

TEST_P(DefaultMethodTraceTest, JudgesALabelAndNotAPoseInTheAir) {
  const Scene scene(image_, params_.evidence.normal_radius, Execution{});
  const DetectorTrace trace = TraceDetector(scene, database_, params_, Execution{});
  const Eigen::Isometry3d T_sensor_local = image_.T_local_sensor().inverse();
  const auto judge = [&](const Eigen::Isometry3d& T_local_object) {
    return JudgePose(scene, trace, {0, T_sensor_local * T_local_object, 0.0}, database_, params_,
                     Execution{});
  };
  ASSERT_EQ(database_.models()[0].name, "sculpture");
  const std::optional<JudgedCandidate> at_label = judge(sculpture_.T_local_object);
  ASSERT_TRUE(at_label.has_value());
  EXPECT_GT(at_label->evidence.values[kMatched], 0.5);
  EXPECT_FALSE(judge(Placed(2.2, 0.4, 1.2, 0.7)).has_value());
}

TEST_P(DetectorTraceTest, CasesAreThoseOfTheCount) {
  // Nothing was found of one labelled object, and a detection stands where nothing is.
  CountedScan scan;
  scan.objects = {sculpture_};
  Detection invented;
  invented.class_name = "stool";
  invented.T_local_object = Placed(3.5, 1.5, 0.0, 0.0);
  invented.box_min = shapes_["stool"].box_min;
  invented.box_max = shapes_["stool"].box_max;
  invented.score = 0.6;
  scan.detections = {invented};
  const std::vector<FoundCase> cases =
      FindCases("a scan", image_, scan, CountHits({scan}, shapes_, HitParams()), database_, shapes_,
                params_, Execution{});
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_EQ(cases[0].words.kind, CaseKind::kMiss);
  EXPECT_EQ(cases[0].words.class_name, "sculpture");
  EXPECT_EQ(cases[0].words.cause, "found when looked for again");
  EXPECT_EQ(cases[0].score_at_label.has_value(), GetParam() == Method::kDefault);
  EXPECT_EQ(cases[1].words.kind, CaseKind::kFalseAlarm);
  EXPECT_EQ(cases[1].words.class_name, "stool");
  for (const FoundCase& found : cases) {
    ASSERT_FALSE(found.poses.empty());
    const cv::Mat picture = DrawCase(image_, found.poses, found.words.cause);
    EXPECT_GT(picture.cols, 1000);
  }
}

}  // namespace
}  // namespace rimod
