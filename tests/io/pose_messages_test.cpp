#include "io/pose_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/io/random_values.h"

namespace rimod {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kNoShift[3] = {0.0, 0.0, 0.0};

Eigen::Isometry3d ThroughMessage(const Eigen::Isometry3d& T_local_sensor) {
  double position[3];
  double orientation[4];
  SetPosition(T_local_sensor.translation(), position);
  SetOrientation(LevelQuaternionOf(T_local_sensor), orientation);
  return LevelPoseFrom(position, orientation).value();
}

Eigen::Isometry3d WithHeading(double heading) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return LevelPose(T);
}

TEST(PoseMessagesTest, LevelPosesComeBackBitForBit) {
  RandomValues random(1);
  for (int i = 0; i < 50000; ++i) {
    const Eigen::Isometry3d T = random.Level();
    ASSERT_EQ(ThroughMessage(T).matrix(), T.matrix()) << "pose " << i;
  }
}

TEST(PoseMessagesTest, LevelPosesWithSpecialHeadingsComeBackBitForBit) {
  for (const double heading : {0.0, -0.0, 1e-300, 1e-16, -1e-9, 1e-3, M_PI / 4, M_PI / 2, -M_PI / 2,
                               3.0, -3.0, M_PI, -M_PI, std::nextafter(M_PI, 0.0),
                               std::nextafter(M_PI / 2, 0.0), std::nextafter(M_PI / 2, 2.0)}) {
    const Eigen::Isometry3d T = WithHeading(heading);
    EXPECT_EQ(ThroughMessage(T).matrix(), T.matrix()) << "heading " << heading;
  }
  for (int degrees = -180; degrees <= 180; ++degrees) {
    const Eigen::Isometry3d T = WithHeading(degrees * M_PI / 180.0);
    EXPECT_EQ(ThroughMessage(T).matrix(), T.matrix()) << degrees << " degrees";
  }
}

TEST(PoseMessagesTest, LevelQuaternionsAreUnitQuaternionsAboutZ) {
  RandomValues random(2);
  for (int i = 0; i < 1000; ++i) {
    const std::array<double, 4> q = LevelQuaternionOf(random.Level());
    EXPECT_NEAR(q[0] * q[0] + q[3] * q[3], 1.0, 1e-14);
    EXPECT_GE(q[0], 0.0);
    EXPECT_EQ(q[1], 0.0);
    EXPECT_EQ(q[2], 0.0);
  }
}

TEST(PoseMessagesTest, TiltedSensorPosesAreMadeLevel) {
  RandomValues random(3);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d T = random.Pose();
    double orientation[4];
    SetOrientation(QuaternionOf(T), orientation);
    const Eigen::Matrix3d R = LevelPoseFrom(kNoShift, orientation).value().linear();
    EXPECT_TRUE(R.isApprox(LevelPose(T).linear(), 1e-9));
  }
}

TEST(PoseMessagesTest, AnyPoseComesBackToRounding) {
  RandomValues random(4);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Isometry3d T = random.Pose();
    double position[3];
    double orientation[4];
    SetPosition(T.translation(), position);
    SetOrientation(QuaternionOf(T), orientation);
    EXPECT_GE(orientation[0], 0.0);
    const Eigen::Isometry3d back = PoseFrom(position, orientation).value();
    EXPECT_EQ(back.translation(), T.translation());
    EXPECT_TRUE(back.linear().isApprox(T.linear(), 1e-14));
  }
}

TEST(PoseMessagesTest, QuaternionsAreWXYZ) {
  const double quarter_turn_about_z[4] = {std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
  const Eigen::Isometry3d T = PoseFrom(kNoShift, quarter_turn_about_z).value();
  EXPECT_TRUE((T * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
}

TEST(PoseMessagesTest, ANearlyUnitQuaternionIsNormalised) {
  const double orientation[4] = {1.005, 0.0, 0.0, 0.0};
  EXPECT_EQ(PoseFrom(kNoShift, orientation).value().linear(), Eigen::Matrix3d::Identity());
}

TEST(PoseMessagesTest, WhatIsNoPoseIsRejected) {
  const double good[4] = {1.0, 0.0, 0.0, 0.0};
  const double zero[4] = {0.0, 0.0, 0.0, 0.0};
  const double twice[4] = {2.0, 0.0, 0.0, 0.0};
  const double nan[4] = {1.0, kNaN, 0.0, 0.0};
  const double huge[4] = {1e308, 1e308, 0.0, 0.0};
  const double far[3] = {0.0, std::numeric_limits<double>::infinity(), 0.0};
  EXPECT_TRUE(PoseFrom(kNoShift, good));
  for (const double* const bad : {zero, twice, nan, huge}) {
    EXPECT_FALSE(PoseFrom(kNoShift, bad));
    EXPECT_FALSE(LevelPoseFrom(kNoShift, bad));
  }
  EXPECT_FALSE(PoseFrom(far, good));
}

}  // namespace
}  // namespace rimod
