#include "viewer_tools/case_causes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/ray_caster.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

constexpr double kRadPerDeg = M_PI / 180.0;

// Two classes of boxes before a sensor at the origin; what the detector's stages left is made up.
class CaseCausesTest : public testing::Test {
 protected:
  CaseCausesTest()
      : image_(Grid(), Eigen::Isometry3d::Identity()),
        database_(
            {BoxModel("crate", {0.4, 0.6, 0.5}, 0.05), BoxModel("trunk", {0.5, 0.5, 0.5}, 0.05)},
            DefaultParams(Method::kDefault), Execution{}) {
    for (const ObjectModel& model : database_.models())
      shapes_[model.name] = {model.box_min, model.box_max, Symmetry::kNone};
    trace_.stages = {{"not proposed", {0.2, 25.0}, {}},
                     {"ranked out", {0.1, 15.0}, {}},
                     {"improbable", {0.1, 15.0}, {}},
                     {"beaten", {0.1, 15.0}, {}}};
    LabelledObject object;
    object.class_name = "crate";
    object.T_local_object = Placed(2.0, 0.0, 0.0, 0.0);
    scan_.objects = {object};
  }

  static PixelGrid Grid() {
    PixelGrid grid;
    grid.width = 120;
    grid.height = 60;
    grid.resolution = 0.01;
    grid.left = 0.6;
    grid.top = 0.4;
    return grid;
  }

  // Candidates of this class at this distance and angle from the object, in the first stages.
  void Leave(const std::string& name, double distance, double angle_deg, int num_stages,
             double score = 0.4) {
    for (int i = 0; i < num_stages; ++i)
      trace_.stages[i].candidates.push_back({ModelNumber(database_, name),
                                             Placed(2.0, distance, 0.0, angle_deg * kRadPerDeg),
                                             score});
    if (num_stages == static_cast<int>(trace_.stages.size()))
      trace_.chosen = trace_.stages.back().candidates;
  }

  static Detection Found(const std::string& name, double x, double y) {
    Detection detection;
    detection.class_name = name;
    detection.T_local_object = Placed(x, y, 0.0, 0.0);
    detection.score = 0.8;
    return detection;
  }

  // A wall of this distance over the columns and rows given.
  void Measure(double range, int first_row, int end_row, int first_column, int end_column) {
    RoundedPixel pixel;
    pixel.range = static_cast<std::uint16_t>(std::lround(range / PixelRounding::kRangeUnit));
    for (int row = first_row; row < end_row; ++row)
      for (int column = first_column; column < end_column; ++column)
        image_.SetMeasured(row, column, pixel);
  }

  CaseContext Context() const { return {image_, scan_, trace_, database_, shapes_, params_}; }
  Explanation WhyMissed() const { return ExplainMiss(Context(), 0); }
  // Of the only detection.
  Explanation WhyFalse() const {
    const HitCount count = CountHits({scan_}, shapes_, HitParams());
    return ExplainFalseAlarm(Context(), 0, count.detections[0][0]);
  }

  RangeImage image_;
  ModelDatabase database_;
  ObjectShapes shapes_;
  DetectorTrace trace_;
  CountedScan scan_;
  PipelineParams params_ = DefaultParams(Method::kDefault);
};

TEST_F(CaseCausesTest, WithoutAnyCandidateItWasNotProposed) {
  const Explanation why = WhyMissed();
  EXPECT_EQ(why.cause, "not proposed");
  EXPECT_FALSE(why.best.has_value());
}

TEST_F(CaseCausesTest, CandidatesOfOtherClassesDoNotHelp) {
  Leave("trunk", 0.0, 0.0, 4);
  EXPECT_EQ(WhyMissed().cause, "not proposed");
}

TEST_F(CaseCausesTest, FirstStageWithoutARightCandidateIsTheCause) {
  Leave("crate", 0.02, 3.0, 2);
  const Explanation why = WhyMissed();
  EXPECT_EQ(why.cause, "improbable");
  ASSERT_TRUE(why.best.has_value());
  EXPECT_NEAR(why.best->T_sensor_object.translation().y(), 0.02, 1e-12);
  EXPECT_NE(why.detail.find("2 cm and 3 degrees off"), std::string::npos) << why.detail;
}

TEST_F(CaseCausesTest, EachStageHasItsTolerance) {
  Leave("crate", 0.15, 20.0, 4);  // near enough to be proposed, not to be in place
  EXPECT_EQ(WhyMissed().cause, "ranked out");
}

TEST_F(CaseCausesTest, WrongHeadingIsNotRight) {
  Leave("crate", 0.0, 90.0, 4);
  const Explanation why = WhyMissed();
  EXPECT_EQ(why.cause, "not proposed");
  ASSERT_TRUE(why.best.has_value());  // the nearest one all the same
}

TEST_F(CaseCausesTest, SymmetryMakesHeadingsEqual) {
  shapes_["crate"].symmetry = Symmetry::kYaw4;
  Leave("crate", 0.0, 90.0, 1);
  EXPECT_EQ(WhyMissed().cause, "ranked out");
}

TEST_F(CaseCausesTest, WinnerIsNamed) {
  Leave("crate", 0.0, 0.0, 3, 0.6);
  trace_.chosen = {{ModelNumber(database_, "trunk"), Placed(2.0, 0.1, 0.0, 0.0), 0.7}};
  trace_.stages.back().candidates = trace_.chosen;
  const Explanation why = WhyMissed();
  EXPECT_EQ(why.cause, "beaten");
  EXPECT_NE(why.detail.find("trunk with 0.70"), std::string::npos) << why.detail;
}

TEST_F(CaseCausesTest, RightAtTheEndMeansThatTheRunDiffered) {
  Leave("crate", 0.0, 0.0, 4);
  EXPECT_EQ(WhyMissed().cause, "found when looked for again");
}

TEST_F(CaseCausesTest, DetectionBesideTheObjectIsTooFarOff) {
  Leave("crate", 0.02, 3.0, 2);
  scan_.detections = {Found("crate", 2.0, 0.4)};
  const Explanation why = WhyMissed();
  EXPECT_EQ(why.cause, "found, but too far off");
  EXPECT_NE(why.detail.find("found 40 cm"), std::string::npos) << why.detail;
  EXPECT_EQ(WhyFalse().cause, "the right object, but too far off");
}

TEST_F(CaseCausesTest, ClassWithoutAModelWasNotLookedFor) {
  scan_.objects[0].class_name = "sofa";
  shapes_["sofa"] = shapes_["crate"];
  EXPECT_EQ(WhyMissed().cause, "not looked for");
}

TEST_F(CaseCausesTest, OtherClassOnTheObjectIsNamed) {
  scan_.detections = {Found("trunk", 2.0, 0.0)};
  EXPECT_EQ(WhyFalse().cause, "takes a crate for a trunk");
}

TEST_F(CaseCausesTest, SecondOnAnObjectIsFoundTwice) {
  scan_.detections = {Found("crate", 2.0, 0.05), Found("crate", 2.0, 0.0)};
  scan_.detections[1].score = 0.9;
  EXPECT_EQ(WhyFalse().cause, "found twice");
}

// A false alarm far from the label whose evidence is given.
class ClutterTest : public CaseCausesTest {
 protected:
  ClutterTest() {
    scan_.objects.clear();
    scan_.detections = {Found("crate", 3.0, 0.0)};
    JudgedCandidate judged;
    judged.candidate = {ModelNumber(database_, "crate"), Placed(3.0, 0.0, 0.0, 0.0), 0.8};
    judged.evidence.values[kRelief] = 0.5;
    trace_.judged = {judged};
  }
};

TEST_F(ClutterTest, ReliefTellsFlatClutter) {
  EXPECT_EQ(WhyFalse().cause, "clutter");
  trace_.judged[0].evidence.values[kRelief] = 0.0;
  EXPECT_EQ(WhyFalse().cause, "clutter that is flat");
}

TEST_F(ClutterTest, NotJudgedAgainIsSaid) {
  trace_.judged.clear();
  const Explanation why = WhyFalse();
  EXPECT_EQ(why.cause, "clutter");
  EXPECT_NE(why.detail.find("not among the candidates"), std::string::npos);
}

// The crate's front, 0.6 m wide and 2.8 m away, spans 21 columns round the middle and 17 rows.
TEST_F(ClutterTest, TwoSidesSeenThroughMeanSomethingSmaller) {
  Measure(6.0, 0, 60, 0, 120);
  Measure(2.8, 24, 43, 54, 66);  // as high as the crate, half as wide
  EXPECT_EQ(WhyFalse().cause, "something smaller");
  Measure(2.8, 20, 45, 45, 75);  // larger than the crate
  EXPECT_EQ(WhyFalse().cause, "clutter");
}

TEST_F(ClutterTest, PartOfALabelledObjectIsSaid) {
  // A labelled trunk stands beside, too far off to count as hit, and takes most matched pixels.
  Measure(6.0, 0, 60, 0, 120);
  Measure(2.76, 20, 45, 40, 80);
  LabelledObject trunk;
  trunk.class_name = "trunk";
  trunk.T_local_object = Placed(3.0, 0.25, 0.0, 0.0);
  scan_.objects = {trunk};
  for (int column = 48; column < 56; ++column)
    trace_.judged[0].evidence.explained.push_back(32 * 120 + column);
  const Explanation why = WhyFalse();
  EXPECT_EQ(why.cause, "a part of another object") << why.detail;
  EXPECT_NE(why.detail.find("trunk"), std::string::npos);
}

}  // namespace
}  // namespace rimod
