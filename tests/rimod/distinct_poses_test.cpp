#include "rimod/distinct_poses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/io/random_values.h"

namespace rimod {
namespace {

constexpr double kDistance = 0.05, kAngle = 0.3;

struct Pose {
  Eigen::Isometry3f T;
  Eigen::Vector3f centre;
};

bool Same(const Pose& a, const Pose& b) {
  const Eigen::Matrix3f turn = a.T.linear().transpose() * b.T.linear();
  const double angle = std::acos(std::min(1.0, std::max(-1.0, (turn.trace() - 1.0) / 2.0)));
  return (a.centre - b.centre).norm() < kDistance && angle < kAngle;
}

TEST(DistinctPosesTest, FindsWhatAComparisonWithAllFinds) {
  RandomValues random(1);
  DistinctPoses distinct(kDistance, kAngle);
  std::vector<Pose> kept;
  int found = 0;
  for (int i = 0; i < 3000; ++i) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.rotate(Eigen::AngleAxisd(random.Between(-0.5, 0.5), Eigen::Vector3d::UnitZ()));
    T.pretranslate(random.Vector(0.15));
    const Pose pose{T.cast<float>(), T.translation().cast<float>()};
    int expected = 0;
    while (expected < static_cast<int>(kept.size()) && !Same(kept[expected], pose)) ++expected;
    ASSERT_EQ(distinct.FindOrAdd(pose.T, pose.centre), expected) << i;
    if (expected == static_cast<int>(kept.size())) {
      kept.push_back(pose);
    } else {
      ++found;
    }
  }
  EXPECT_GT(found, 300);
  EXPECT_GT(kept.size(), 300u);
}

TEST(DistinctPosesTest, VeryFarPosesAreDistinctToo) {
  DistinctPoses distinct(kDistance, kAngle);
  const Eigen::Isometry3f T = Eigen::Isometry3f::Identity();
  EXPECT_EQ(distinct.FindOrAdd(T, {1e30f, 0, 0}), 0);
  EXPECT_EQ(distinct.FindOrAdd(T, {-1e30f, 0, 0}), 1);
  EXPECT_EQ(distinct.FindOrAdd(T, {0, 0, 0}), 2);
  EXPECT_EQ(distinct.FindOrAdd(T, {0.04f, 0, 0}), 2);
}

}  // namespace
}  // namespace rimod
