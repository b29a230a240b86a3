#include "rimod/hit_counting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace rimod {
namespace {

// A crate, 0.4 x 0.6 x 0.5 m (diameter 0.877, so hits lie within 0.219 m), and a cup so small that
// hits lie within 0.15 m.
ObjectShapes Shapes() {
  ObjectShape crate{{-0.2, -0.3, 0.0}, {0.2, 0.3, 0.5}, Symmetry::kYaw2};
  ObjectShape cup{{-0.05, -0.05, 0.0}, {0.05, 0.05, 0.1}, Symmetry::kYawContinuous};
  return {{"crate", crate}, {"cup", cup}};
}

Eigen::Isometry3d At(double x, double y, double yaw = 0.0) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, 0.0);
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

LabelledObject Object(const std::string& name, double x, double y) {
  LabelledObject object;
  object.class_name = name;
  object.T_local_object = At(x, y);
  return object;
}

Detection Found(const std::string& name, double x, double y, double score, double yaw = 0.0) {
  Detection detection;
  detection.class_name = name;
  detection.T_local_object = At(x, y, yaw);
  detection.score = score;
  return detection;
}

TEST(HitCountingTest, DetectionWithinAQuarterOfTheDiameterIsRight) {
  const CountedScan scan{{Object("crate", 2.0, 0.0)}, {Found("crate", 2.2, 0.0, 0.9)}};
  const HitCount count = CountHits({scan}, Shapes(), HitParams());
  EXPECT_EQ(count.detections[0][0].verdict, Verdict::kRight);
  EXPECT_EQ(count.detections[0][0].object, 0);
  EXPECT_EQ(count.objects[0][0].detection, 0);
  EXPECT_NEAR(count.objects[0][0].error.distance, 0.2, 1e-12);
  EXPECT_EQ(count.total.right, 1);
  EXPECT_EQ(count.num_posed, 0);  // 20 cm are too far for that
  EXPECT_TRUE(std::isinf(count.total.Zeta()));
}

TEST(HitCountingTest, DetectionFartherOffIsClutterAndTheObjectMissed) {
  const CountedScan scan{{Object("crate", 2.0, 0.0)}, {Found("crate", 2.23, 0.0, 0.9)}};
  const HitCount count = CountHits({scan}, Shapes(), HitParams());
  EXPECT_EQ(count.detections[0][0].verdict, Verdict::kClutter);
  EXPECT_EQ(count.detections[0][0].object, -1);
  EXPECT_FALSE(count.objects[0][0].found());
  EXPECT_EQ(count.total.missed, 1);
  EXPECT_EQ(count.total.false_alarms, 1);
  EXPECT_EQ(count.confusion.at({"crate", ""}), 1);
}

TEST(HitCountingTest, SmallObjectsAreHitWithinFifteenCentimetres) {
  EXPECT_DOUBLE_EQ(Shapes().at("cup").HitRadius(), 0.15);
  const CountedScan scan{{Object("cup", 2.0, 0.0)}, {Found("cup", 2.14, 0.0, 0.9)}};
  EXPECT_EQ(CountHits({scan}, Shapes(), HitParams()).total.right, 1);
}

TEST(HitCountingTest, OtherClassOnTheObjectIsAConfusion) {
  CountedScan scan{{Object("crate", 2.0, 0.0)}, {Found("cup", 2.0, 0.0, 0.9)}};
  scan.objects[0].T_local_object.translation().z() = -0.2;  // centres 5 cm apart
  const HitCount count = CountHits({scan}, Shapes(), HitParams());
  EXPECT_EQ(count.detections[0][0].verdict, Verdict::kConfusion);
  EXPECT_EQ(count.confusion.at({"cup", "crate"}), 1);
  EXPECT_EQ(count.total.missed, 1);
  EXPECT_EQ(count.total.false_alarms, 1);
}

TEST(HitCountingTest, BestScoreCountsAndTheSecondIsADuplicate) {
  const CountedScan scan{{Object("crate", 2.0, 0.0)},
                         {Found("crate", 2.0, 0.0, 0.6), Found("crate", 2.1, 0.0, 0.8)}};
  const HitCount count = CountHits({scan}, Shapes(), HitParams());
  EXPECT_EQ(count.detections[0][0].verdict, Verdict::kDuplicate);
  EXPECT_EQ(count.detections[0][1].verdict, Verdict::kRight);
  EXPECT_EQ(count.duplicates.at("crate"), 1);
  EXPECT_EQ(count.total.false_alarms, 1);
  EXPECT_EQ(count.total.missed, 0);
}

TEST(HitCountingTest, SecondDetectionTakesAFreeObjectOfItsClassFirst) {
  // Both lie within reach of both crates; the nearest of the second one is taken already.
  const CountedScan scan{{Object("crate", 2.0, 0.0), Object("crate", 2.2, 0.0)},
                         {Found("crate", 2.01, 0.0, 0.9), Found("crate", 2.05, 0.0, 0.8)}};
  const HitCount count = CountHits({scan}, Shapes(), HitParams());
  EXPECT_EQ(count.total.right, 2);
  EXPECT_EQ(count.detections[0][1].object, 1);
}

TEST(HitCountingTest, HardlyVisibleObjectsAreNeitherMissedNorFound) {
  CountedScan scan{{Object("crate", 2.0, 0.0), Object("crate", 5.0, 0.0)},
                   {Found("crate", 2.0, 0.0, 0.9)}};
  scan.objects[0].visible = 0.1;
  scan.objects[1].num_points = 20;
  const HitCount count = CountHits({scan}, Shapes(), HitParams());
  EXPECT_EQ(count.detections[0][0].verdict, Verdict::kIgnored);
  EXPECT_EQ(count.num_ignored, 1);
  EXPECT_EQ(count.num_other_objects, 2);
  EXPECT_EQ(count.total.right + count.total.missed + count.total.false_alarms, 0);
}

TEST(HitCountingTest, ScansDoNotMix) {
  const CountedScan with{{Object("crate", 2.0, 0.0)}, {}};
  const CountedScan without{{}, {Found("crate", 2.0, 0.0, 0.9)}};
  const HitCount count = CountHits({with, without}, Shapes(), HitParams());
  EXPECT_EQ(count.total.missed, 1);
  EXPECT_EQ(count.total.false_alarms, 1);
}

TEST(HitCountingTest, ClassWithoutAShapeIsRefusedByName) {
  try {
    CountHits({{{Object("crate", 2.0, 0.0)}, {Found("sofa", 2.0, 0.0, 0.9)}}}, Shapes(),
              HitParams());
    FAIL() << "accepted";
  } catch (const std::invalid_argument& refused) {
    EXPECT_NE(std::string(refused.what()).find("sofa"), std::string::npos);
  }
}

TEST(HitCountingTest, SymmetricTurnsAreNoPoseError) {
  const ObjectShapes shapes = Shapes();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  for (int i = 0; i < 50; ++i) {
    const double yaw = angle(random);
    EXPECT_NEAR(PoseErrorBetween(At(1, 2, yaw), At(1, 2, yaw + M_PI), shapes.at("crate")).angle_deg,
                0.0, 1e-5);
    EXPECT_NEAR(
        PoseErrorBetween(At(1, 2, yaw), At(1, 2, angle(random)), shapes.at("cup")).angle_deg, 0.0,
        1e-5);
    EXPECT_NEAR(
        PoseErrorBetween(At(1, 2, yaw), At(1, 2, yaw + 0.5 * M_PI), shapes.at("crate")).angle_deg,
        90.0, 1e-5);
  }
}

// Whatever is there, every detection and every object is counted once.
TEST(HitCountingTest, SumsAgreeOnRandomScans) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-0.6, 0.6);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int round = 0; round < 100; ++round) {
    CountedScan scan;
    for (int i = 0; i < 4; ++i) {
      scan.objects.push_back(Object(share(random) < 0.5 ? "crate" : "cup", place(random), 0.0));
      scan.objects.back().visible = share(random);
    }
    for (int i = 0; i < 8; ++i)
      scan.detections.push_back(
          Found(share(random) < 0.5 ? "crate" : "cup", place(random), 0.0, share(random)));
    const HitCount count = CountHits({scan}, Shapes(), HitParams());
    EXPECT_EQ(count.total.right + count.total.missed, count.num_counted_objects);
    EXPECT_EQ(count.total.right + count.total.false_alarms + count.num_ignored, 8);
    int in_table = 0;
    for (const auto& [cell, number] : count.confusion) in_table += number;
    for (const auto& [name, number] : count.duplicates) in_table += number;
    EXPECT_EQ(in_table, count.total.right + count.total.false_alarms);
    EXPECT_LE(count.num_posed, count.total.right);
  }
}

TEST(HitCountingTest, NothingAtAllGivesZeros) {
  const HitCount count = CountHits({}, {}, HitParams());
  EXPECT_EQ(count.total.Recall(), 0.0);
  EXPECT_EQ(count.total.Precision(), 0.0);
  EXPECT_EQ(count.total.Zeta(), 0.0);
}

}  // namespace
}  // namespace rimod
