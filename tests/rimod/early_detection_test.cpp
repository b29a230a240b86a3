#include "rimod/early_detection.h"

#include <gtest/gtest.h>

#include "rimod/evidence.h"
#include "rimod/scene.h"
#include "tests/support/matchers.h"
#include "tests/support/ray_caster.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

const Eigen::Vector3d kSize(0.5, 0.4, 0.6);
const Eigen::Isometry3d kPose = Placed(2.2, 0.1, -0.8, 0.5);

const ObjectModel& Crate() {
  static const ObjectModel crate = BoxModel("crate", kSize, 0.01);
  return crate;
}

// A crate before a wall on a floor, swept from the top down to this elevation.
RangeImage SweptDownTo(double elevation, double step = 0.0069) {
  World world;
  world.planes = {{Eigen::Vector3d(4, 0, 0), -Eigen::Vector3d::UnitX()},
                  {Eigen::Vector3d(0, 0, -0.8), Eigen::Vector3d::UnitZ()}};
  BoxShape box;
  box.T_local_box = kPose * Eigen::Translation3d(0, 0, 0.5 * kSize.z());
  box.half_size = 0.5 * kSize;
  world.boxes.push_back(box);
  BeamPattern pattern;
  pattern.elevation_min = elevation;
  pattern.step = step;
  RangeImageParams params;
  params.resolution = 0.0069;
  return MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), pattern), params);
}

TEST(UnseenShareTest, FallsFromOneToNoneWhileTheSweepPassesTheObject) {
  // The crate reaches from about -0.39 to -0.07 rad.
  EXPECT_EQ(UnseenShare(SweptDownTo(-0.02), Crate(), kPose), 1.0);
  EXPECT_EQ(UnseenShare(SweptDownTo(-0.5), Crate(), kPose), 0.0);
  double last = 1.0;
  for (const double elevation : {-0.1, -0.15, -0.2, -0.25, -0.3, -0.35}) {
    const double share = UnseenShare(SweptDownTo(elevation), Crate(), kPose);
    EXPECT_LT(share, last) << elevation;
    EXPECT_GT(share, 0.0) << elevation;
    last = share;
  }
}

TEST(UnseenShareTest, EmptyPixelsAmongObservedOnesAreNotUnseen) {
  EXPECT_EQ(UnseenShare(SweptDownTo(-0.5, 2.5 * 0.0069), Crate(), kPose), 0.0);
}

TEST(UnseenShareTest, AnImageOfNothingShowsNothing) {
  EXPECT_EQ(UnseenShare(RangeImage(), Crate(), kPose), 1.0);
  ObjectModel nothing = Crate();
  nothing.points.clear();
  nothing.normals.clear();
  EXPECT_EQ(UnseenShare(SweptDownTo(-0.5), nothing, kPose), 1.0);
}

TEST(UnseenShareTest, NeverObservedPixelsInsideTheImageAreUnseen) {
  const RangeImage whole = SweptDownTo(-0.5);
  RangeImage left(whole.grid(), whole.T_local_sensor());
  for (int row = 0; row < whole.height(); ++row) {
    for (int column = 0; column < whole.width() / 2; ++column) {
      if (whole.measured(row, column)) left.SetMeasured(row, column, whole.rounded(row, column));
    }
  }
  const double share = UnseenShare(left, Crate(), kPose);
  EXPECT_GT(share, 0.2);
  EXPECT_LT(share, 0.9);
}

// The judgement must not take what was not swept yet for free space, nor for absent.
TEST(HalfSweptSceneTest, EvidenceRestsOnWhatWasSwept) {
  const JudgedModel model(Crate());
  const auto evidence = [&](const RangeImage& image) {
    return GatherEvidence(Scene(image, 0.05, Execution{}), model, kPose, EvidenceParams{});
  };
  const Evidence whole = evidence(SweptDownTo(-0.5)), half = evidence(SweptDownTo(-0.2));
  EXPECT_LT(half.values[kLogRenderedPixels], whole.values[kLogRenderedPixels]);
  EXPECT_GT(half.values[kMatched], 0.85);
  EXPECT_NEAR(half.values[kMatched], whole.values[kMatched], 0.1);
  EXPECT_LT(half.values[kSeenThrough], 0.02);
  EXPECT_LT(half.values[kSilhouetteContinues], 0.05);
}

Detection DetectionAt(const std::string& class_name, double x, double score = 0.9) {
  Detection detection;
  detection.class_name = class_name;
  detection.T_local_object = Placed(x, 0, 0, 0);
  detection.box_min = Eigen::Vector3d(-0.25, -0.25, 0);
  detection.box_max = Eigen::Vector3d(0.25, 0.25, 0.5);
  detection.score = score;
  return detection;
}

EarlySighting Sighted(const std::string& class_name, double x, double unseen = 0.0,
                      double score = 0.9) {
  return {DetectionAt(class_name, x, score), unseen};
}

constexpr Time kSweep(100);

EarlyParams Params() {
  EarlyParams params;
  params.max_unseen_share = 0.1;
  params.min_score = 0.5;
  params.min_sightings = 1;
  params.max_misses = 1;
  params.same_object_distance = 0.4;
  return params;
}

TEST(EarlyTrackerTest, AnObjectKeepsItsIdWhileItsPoseIsUpdated) {
  EarlyTracker tracker(Params());
  const auto first = tracker.Update(kSweep, Time(110), {Sighted("box", 1.0)});
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].status, EarlyStatus::kNew);
  EXPECT_EQ(first[0].first_told, Time(110));
  const auto second = tracker.Update(kSweep, Time(120), {Sighted("box", 1.1)});
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(second[0].id, first[0].id);
  EXPECT_EQ(second[0].status, EarlyStatus::kConfirmed);
  EXPECT_EQ(second[0].first_told, Time(110));
  EXPECT_EQ(second[0].detection.T_local_object.translation().x(), 1.1);
}

TEST(EarlyTrackerTest, AnObjectAtTheGrowingEdgeIsHeldBack) {
  EarlyTracker tracker(Params());
  EXPECT_TRUE(tracker.Update(kSweep, Time(110), {Sighted("box", 1.0, 0.5)}).empty());
  EXPECT_TRUE(tracker.Update(kSweep, Time(120), {Sighted("box", 1.0, 0.11)}).empty());
  EXPECT_EQ(tracker.Update(kSweep, Time(130), {Sighted("box", 1.0, 0.1)}).size(), 1u);
}

TEST(EarlyTrackerTest, EvidenceMustSufficeInSoManyLooksInARow) {
  EarlyParams params = Params();
  params.min_sightings = 2;
  params.min_score = 0.7;
  EarlyTracker tracker(params);
  EXPECT_TRUE(tracker.Update(kSweep, Time(110), {Sighted("box", 1.0)}).empty());
  EXPECT_TRUE(tracker.Update(kSweep, Time(120), {Sighted("box", 1.0, 0.0, 0.6)}).empty());
  EXPECT_TRUE(tracker.Update(kSweep, Time(130), {Sighted("box", 1.0)}).empty());
  EXPECT_TRUE(tracker.Update(kSweep, Time(140), {}).empty());
  EXPECT_TRUE(tracker.Update(kSweep, Time(150), {Sighted("box", 1.0)}).empty());
  EXPECT_EQ(tracker.Update(kSweep, Time(160), {Sighted("box", 1.0)}).size(), 1u);
}

TEST(EarlyTrackerTest, WhatIsNotFoundAnyMoreIsWithdrawnAndComesBackWithItsId) {
  EarlyTracker tracker(Params());
  const auto status = [](const std::vector<EarlyObject>& told) { return told.at(0).status; };
  const std::int64_t id = tracker.Update(kSweep, Time(1), {Sighted("box", 1.0)}).at(0).id;
  EXPECT_EQ(status(tracker.Update(kSweep, Time(2), {})), EarlyStatus::kUnseen);
  EXPECT_EQ(status(tracker.Update(kSweep, Time(3), {})), EarlyStatus::kWithdrawn);
  EXPECT_EQ(status(tracker.Update(kSweep, Time(4), {})), EarlyStatus::kWithdrawn);
  const auto back = tracker.Update(kSweep, Time(5), {Sighted("box", 1.0)});
  EXPECT_EQ(status(back), EarlyStatus::kConfirmed);
  EXPECT_EQ(back.at(0).id, id);
}

TEST(EarlyTrackerTest, ClassAndPlaceTellObjectsApart) {
  EarlyTracker tracker(Params());
  // Diameter 0.87: the same object within 0.35 m.
  const auto first = tracker.Update(kSweep, Time(1), {Sighted("box", 1.0), Sighted("box", 1.6)});
  ASSERT_EQ(first.size(), 2u);
  const auto second = tracker.Update(
      kSweep, Time(2), {Sighted("fan", 1.0), Sighted("box", 1.5), Sighted("box", 1.2)});
  ASSERT_EQ(second.size(), 3u);
  EXPECT_EQ(second[0].id, first[0].id);
  EXPECT_EQ(second[0].detection.T_local_object.translation().x(), 1.2);
  EXPECT_EQ(second[1].id, first[1].id);
  EXPECT_EQ(second[1].detection.T_local_object.translation().x(), 1.5);
  EXPECT_EQ(second[2].detection.class_name, "fan");
  EXPECT_EQ(second[2].status, EarlyStatus::kNew);
}

TEST(EarlyTrackerTest, TheFinalResultIsThatOfTheScanWithWhatIsWithdrawnBehind) {
  EarlyTracker tracker(Params());
  const auto told = tracker.Update(
      kSweep, Time(1), {Sighted("box", 1.0), Sighted("fan", 3.0), Sighted("cup", 5.0, 0.9)});
  ASSERT_EQ(told.size(), 2u);
  const std::vector<Detection> detections = {DetectionAt("cup", 5.0), DetectionAt("box", 1.05),
                                             DetectionAt("jar", 7.0)};
  const auto last = tracker.Finish(kSweep, Time(9), detections);
  ASSERT_EQ(last.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(last[i].detection.class_name, detections[i].class_name);
    EXPECT_EQ(last[i].detection.T_local_object.matrix(), detections[i].T_local_object.matrix());
    EXPECT_EQ(last[i].detection.score, detections[i].score);
  }
  EXPECT_EQ(last[0].status, EarlyStatus::kNew);
  EXPECT_EQ(last[0].first_told, Time(9));
  EXPECT_EQ(last[1].status, EarlyStatus::kConfirmed);
  EXPECT_EQ(last[1].id, told[0].id);
  EXPECT_EQ(last[1].first_told, Time(1));
  EXPECT_EQ(last[2].status, EarlyStatus::kNew);
  EXPECT_EQ(last[3].status, EarlyStatus::kWithdrawn);
  EXPECT_EQ(last[3].id, told[1].id);
  std::vector<std::int64_t> ids;
  for (const EarlyObject& object : last) ids.push_back(object.id);
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::unique(ids.begin(), ids.end()), ids.end());
}

TEST(EarlyTrackerTest, ASweepWithoutALookIsFinishedAsItIs) {
  EarlyTracker tracker(Params());
  const auto last = tracker.Finish(kSweep, Time(9), {DetectionAt("box", 1.0)});
  ASSERT_EQ(last.size(), 1u);
  EXPECT_EQ(last[0].status, EarlyStatus::kNew);
  EXPECT_TRUE(tracker.Finish(kSweep, Time(9), {}).empty());
}

TEST(EarlyTrackerTest, ObjectsOfAnotherSweepAreOthers) {
  EarlyTracker tracker(Params());
  const auto first = tracker.Update(kSweep, Time(1), {Sighted("box", 1.0)});
  const auto second = tracker.Update(Time(500), Time(501), {Sighted("box", 1.0)});
  ASSERT_EQ(second.size(), 1u);
  EXPECT_NE(second[0].id, first[0].id);
  EXPECT_EQ(second[0].status, EarlyStatus::kNew);
  EXPECT_TRUE(tracker.Finish(kSweep, Time(2), {}).empty());
}

TEST(EarlyTrackerTest, ParametersOutOfRangeAreRefused) {
  EarlyParams params;
  params.period = -1.0;
  EXPECT_TRUE(Complains([&] { EarlyTracker tracker(params); }, {"early", "period", "-1"}));
}

}  // namespace
}  // namespace rimod
