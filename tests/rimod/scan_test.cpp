#include "rimod/scan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/io/random_values.h"
#include "tests/support/matchers.h"

namespace rimod {
namespace {

TEST(LevelPoseTest, KeepsPositionAndHeadingAndStandsUpright) {
  RandomValues random(1);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Isometry3d T = random.Pose();
    const Eigen::Isometry3d level = LevelPose(T);
    EXPECT_EQ(level.translation(), T.translation());
    EXPECT_NEAR(level.linear().determinant(), 1.0, 1e-12);
    EXPECT_NEAR((level.linear().col(2) - Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-12);
    const Eigen::Vector2d before = T.linear().col(0).head<2>().normalized();
    EXPECT_NEAR((level.linear().col(0).head<2>() - before).norm(), 0.0, 1e-9);
  }
}

TEST(LevelPoseTest, ALevelPoseStaysAsItIs) {
  RandomValues random(2);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d level = random.Level();
    EXPECT_TRUE(PosesNear(LevelPose(level), level, 0.0, 1e-7));
  }
}

TEST(LevelPoseTest, LookingStraightUpOrDownHasHeadingZero) {
  for (const double pitch : {-M_PI / 2, M_PI / 2}) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()).toRotationMatrix();
    T.translation() = Eigen::Vector3d(1, 2, 3);
    EXPECT_TRUE(LevelPose(T).linear().isIdentity(1e-12));
    EXPECT_EQ(LevelPose(T).translation(), T.translation());
  }
}

}  // namespace
}  // namespace rimod
