#include "web_viewer/page_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/web_viewer/decoded_frame.h"

namespace rimod {
namespace {

Eigen::Isometry3d Turned(double angle, const Eigen::Vector3d& position) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(position);
  T.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  return T;
}

Scan RandomScan(int num_points, double azimuth_right, double azimuth_left) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> azimuth(azimuth_right, azimuth_left);
  std::uniform_real_distribution<double> elevation(-0.6, 0.4);
  std::uniform_real_distribution<double> range(0.5, 9.0);
  Scan scan;
  scan.T_local_sensor = Turned(0.7, {3.0, -2.0, 1.2});
  for (int i = 0; i < num_points; ++i) {
    const double a = azimuth(random);
    const double e = elevation(random);
    const Eigen::Vector3d direction(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a),
                                    std::sin(e));
    const Eigen::Vector3d p_local = scan.T_local_sensor * (range(random) * direction);
    scan.points.push_back(p_local.cast<float>());
  }
  return scan;
}

Detection FanAt(const Eigen::Vector3d& position) {
  return {"fan", Turned(0.3, position), {-0.2, -0.2, 0.0}, {0.2, 0.2, 0.5}, 0.9};
}

TEST(PageFramesTest, ListsBeginAtMultiplesOfEight) {
  for (int i = 0; i < 20; ++i) {
    const Frame frame = MakeFrame("{\"text\":\"" + std::string(i, 'x') + "\"}");
    EXPECT_EQ(frame->size() % 8, 0U);
    EXPECT_EQ(DecodeFrame(*frame).begin % 8, 0U);
    EXPECT_EQ(DecodeFrame(*frame).header["text"], std::string(i, 'x'));
  }
}

TEST(PageFramesTest, PointsComeBackWithinHalfAStep) {
  const Scan scan = RandomScan(5000, -1.5, 1.5);
  const DecodedFrame frame = DecodeFrame(*ScanFrame(4, 1234567890123456, scan));
  EXPECT_EQ(frame.header["type"], "scan");
  EXPECT_EQ(frame.header["id"], 4);
  EXPECT_EQ(frame.header["utime"], "1234567890123456");
  EXPECT_EQ(frame.header["num_points"], 5000);
  ASSERT_EQ(frame.header["points"]["count"], 5000);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double step = frame.header["points"]["step"][axis];
      const double origin = frame.header["points"]["origin"][axis];
      const double value = origin + step * Uint16At(frame.lists, 3 * i + axis);
      EXPECT_NEAR(value, static_cast<double>(scan.points[i][axis]), 0.5001 * step);
      EXPECT_LT(step, 0.001);
    }
  }
}

TEST(PageFramesTest, AnEmptyScanIsAFrame) {
  const DecodedFrame frame = DecodeFrame(*ScanFrame(1, 0, Scan{}));
  EXPECT_EQ(frame.header["points"]["count"], 0);
  EXPECT_TRUE(frame.lists.empty());
}

TEST(PageFramesTest, EqualPointsAndOnePointAreFrames) {
  Scan scan;
  scan.points.assign(3, Eigen::Vector3f(1.0f, 2.0f, 3.0f));
  const DecodedFrame frame = DecodeFrame(*ScanFrame(1, 0, scan));
  EXPECT_EQ(frame.header["points"]["count"], 3);
  EXPECT_EQ(frame.header["points"]["origin"][2], 3.0);
  EXPECT_EQ(Uint16At(frame.lists, 8), 0);
}

TEST(PageFramesTest, PointsFarAwayDoNotCoarsenTheOthers) {
  Scan scan = RandomScan(100, -1.0, 1.0);
  scan.points.emplace_back(1e30f, 0.0f, 0.0f);
  scan.points.emplace_back(0.0f, -3e38f, 0.0f);
  const DecodedFrame frame = DecodeFrame(*ScanFrame(1, 0, scan));
  EXPECT_EQ(frame.header["num_points"], 102);
  EXPECT_EQ(frame.header["points"]["count"], 100);
  EXPECT_LT(frame.header["points"]["step"][0], 0.001);
}

TEST(PageFramesTest, AScanOfMillionsIsThinned) {
  Scan scan;
  scan.points.assign(1'000'001, Eigen::Vector3f(1.0f, 0.0f, 0.0f));
  const DecodedFrame frame = DecodeFrame(*ScanFrame(1, 0, scan));
  EXPECT_LE(frame.header["points"]["count"], kMaxDrawnPoints);
  EXPECT_GE(frame.header["points"]["count"], kMaxDrawnPoints / 2);
}

TEST(PageFramesTest, FieldOfViewHoldsAllPointsClosely) {
  constexpr double kDegree = 0.0175;
  for (const auto& [right, left] : {std::pair{-1.5, 1.5}, {-0.2, 2.0}, {2.5, 4.0}, {-4.0, -2.8}}) {
    const FieldOfView view = FieldOfViewOf(RandomScan(20'000, right, left));
    EXPECT_NEAR(view.azimuth_left - view.azimuth_right, left - right, 2.5 * kDegree);
    EXPECT_NEAR(std::remainder(view.azimuth_right - right, 2.0 * M_PI), 0.0, 1.5 * kDegree);
    EXPECT_NEAR(view.elevation_bottom, -0.6, kDegree);
    EXPECT_NEAR(view.elevation_top, 0.4, kDegree);
    EXPECT_NEAR(view.range, 0.5 + 0.9 * 8.5, 0.2);
  }
}

TEST(PageFramesTest, FieldOfViewOfAFullCircle) {
  const FieldOfView view = FieldOfViewOf(RandomScan(20'000, -M_PI, M_PI));
  EXPECT_DOUBLE_EQ(view.azimuth_right, -M_PI);
  EXPECT_DOUBLE_EQ(view.azimuth_left, M_PI);
}

TEST(PageFramesTest, FieldOfViewCountsBeamsWithoutReturn) {
  Scan scan;
  scan.no_return_directions = {Eigen::Vector3f(1.0f, 0.0f, 0.0f),
                               Eigen::Vector3f(0.0f, 1.0f, 0.0f)};
  EXPECT_EQ(FieldOfViewOf(scan).range, 0.0);
  EXPECT_GT(FieldOfViewOf(scan).azimuth_left, FieldOfViewOf(scan).azimuth_right);
}

TEST(PageFramesTest, ObjectsAreListedWithWhatIsKnown) {
  SceneObjects objects;
  objects.detections = {FanAt({1.0, 2.0, 0.5})};
  objects.num_models = 7;
  objects.hypotheses = {{"box", Turned(0.0, {0.0, 1.0, 0.0}), 0.4, HypothesisStage::kPruned}};
  objects.num_hypotheses = 12;
  EarlyObject early;
  early.detection = FanAt({1.0, 2.0, 0.6});
  objects.early = {early, early};
  objects.early[1].status = EarlyStatus::kWithdrawn;
  const nlohmann::json header = DecodeFrame(*ObjectsFrame(3, 5, objects)).header;
  EXPECT_EQ(header["id"], 3);
  EXPECT_EQ(header["detections"][0]["class"], "fan");
  EXPECT_EQ(header["detections"][0]["pose"][1], 2.0);
  EXPECT_EQ(header["detections"][0]["box"][1][2], 0.5);
  EXPECT_EQ(header["hypotheses"][0]["stage"], "pruned");
  EXPECT_EQ(header["num_hypotheses"], 12);
  EXPECT_EQ(header["early"].size(), 1U);
}

TEST(PageFramesTest, NothingKnownIsNotNothingFound) {
  SceneObjects objects;
  EXPECT_TRUE(DecodeFrame(*ObjectsFrame(1, 1, objects)).header["detections"].is_null());
  objects.detections.emplace();
  EXPECT_EQ(DecodeFrame(*ObjectsFrame(1, 1, objects)).header["detections"].size(), 0U);
}

TEST(PageFramesTest, HypothesesAreLimited) {
  SceneObjects objects;
  objects.hypotheses.assign(3 * kMaxGhosts,
                            {"box", Eigen::Isometry3d::Identity(), 0.4, HypothesisStage::kScored});
  EXPECT_EQ(DecodeFrame(*ObjectsFrame(1, 1, objects)).header["hypotheses"].size(), kMaxGhosts);
}

TEST(PageFramesTest, AModelsSurfaceHasNormalsAndIsThinned) {
  ObjectModel model;
  model.name = "plate";
  model.point_spacing = 0.01;
  for (int i = 0; i < static_cast<int>(2 * kMaxModelPoints); ++i) {
    model.points.emplace_back(0.001f * static_cast<float>(i), 0.0f, 0.0f);
    model.normals.emplace_back(0.0f, 0.0f, -1.0f);
  }
  const DecodedFrame frame = DecodeFrame(*ModelFrame(model));
  const std::size_t count = frame.header["points"]["count"];
  EXPECT_EQ(count, kMaxModelPoints);
  EXPECT_NEAR(frame.header["spacing"], 0.01 * std::sqrt(2.0), 1e-6);
  const std::size_t normals = 6 * count;  // a multiple of 8 already
  EXPECT_EQ(static_cast<std::int8_t>(frame.lists.at(normals + 2)), -127);
  EXPECT_EQ(frame.lists.size(), normals + 4 * count);
}

}  // namespace
}  // namespace rimod
