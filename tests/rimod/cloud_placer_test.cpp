#include "rimod/cloud_placer.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/io/random_values.h"
#include "tests/support/matchers.h"

namespace rimod {
namespace {

constexpr std::int64_t kStart = 1'000'000'000;

SensorCloud CloudAt(std::int64_t utime, unsigned seed = 1) {
  RandomValues random(seed);
  SensorCloud cloud;
  cloud.time = Time(utime);
  for (int i = 0; i < 50; ++i) cloud.points.push_back(random.Vector(10.0).cast<float>());
  return cloud;
}

// Drives at 1 m/s along x while it turns by 0.5 rad/s.
TimedPose PoseAt(std::int64_t utime) {
  const double seconds = static_cast<double>(utime - kStart) * 1e-6;
  TimedPose pose;
  pose.time = Time(utime);
  pose.T_local_laser.linear() =
      Eigen::AngleAxisd(0.5 * seconds, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.T_local_laser.translation() = Eigen::Vector3d(seconds, 2.0, 0.0);
  return pose;
}

void ExpectSame(const PlacedCloud& a, const PlacedCloud& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.scan.points, b.scan.points);
  EXPECT_EQ(a.scan.T_local_sensor.matrix(), b.scan.T_local_sensor.matrix());
}

TEST(CloudPlacerTest, WithoutPosesTheMountPlacesThePoints) {
  CloudParams params;
  params.mount_x = 0.2;
  params.mount_z = 1.4;
  params.mount_yaw = 0.3;
  params.mount_pitch = 0.2;
  CloudPlacer placer(params, /*with_poses=*/false);
  const SensorCloud cloud = CloudAt(kStart);
  const std::vector<PlacedCloud> placed = placer.AddCloud(cloud);
  ASSERT_EQ(placed.size(), 1u);
  EXPECT_EQ(placed[0].time, cloud.time);
  const Scan& scan = placed[0].scan;
  EXPECT_TRUE(PosesNear(scan.T_local_sensor, LevelPose(MountPose(params)), 1e-9, 1e-9));
  ASSERT_EQ(scan.points.size(), cloud.points.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d expected = MountPose(params) * cloud.points[i].cast<double>();
    EXPECT_LT((scan.points[i].cast<double>() - expected).norm(), 1e-5);
  }
}

TEST(CloudPlacerTest, ACamerasOpticalFrameIsAMountLikeAnyOther) {
  CloudParams params;
  params.mount_roll = -M_PI / 2.0;
  params.mount_yaw = -M_PI / 2.0;
  const Eigen::Isometry3d T_carrier_camera = MountPose(params);
  // Optical axes: x right, y down, z forward.
  EXPECT_LT((T_carrier_camera * Eigen::Vector3d(0, 0, 1) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((T_carrier_camera * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0, -1, 0)).norm(),
            1e-12);
  EXPECT_LT((T_carrier_camera * Eigen::Vector3d(0, 1, 0) - Eigen::Vector3d(0, 0, -1)).norm(),
            1e-12);
}

TEST(CloudPlacerTest, MountPitchLooksDownAndYawLooksLeft) {
  CloudParams params;
  params.mount_pitch = 0.1;
  EXPECT_LT((MountPose(params) * Eigen::Vector3d::UnitX()).z(), 0.0);
  params = CloudParams();
  params.mount_yaw = 0.1;
  EXPECT_GT((MountPose(params) * Eigen::Vector3d::UnitX()).y(), 0.0);
}

TEST(CloudPlacerTest, ThePoseIsInterpolatedAtTheCloudsTime) {
  CloudPlacer placer(CloudParams(), /*with_poses=*/true);
  EXPECT_TRUE(placer.AddPose(PoseAt(kStart)).empty());
  EXPECT_TRUE(placer.AddCloud(CloudAt(kStart + 30'000)).empty());
  const std::vector<PlacedCloud> placed = placer.AddPose(PoseAt(kStart + 100'000));
  ASSERT_EQ(placed.size(), 1u);
  EXPECT_TRUE(
      PosesNear(placed[0].scan.T_local_sensor, PoseAt(kStart + 30'000).T_local_laser, 1e-6, 1e-6));
}

TEST(CloudPlacerTest, ResultDoesNotDependOnHowTheStreamsInterleave) {
  std::vector<PlacedCloud> clouds_first, poses_first;
  const auto append = [](std::vector<PlacedCloud> more, std::vector<PlacedCloud>* all) {
    for (PlacedCloud& cloud : more) all->push_back(std::move(cloud));
  };
  CloudPlacer a(CloudParams(), true), b(CloudParams(), true);
  for (int i = 0; i < 5; ++i) {
    append(a.AddPose(PoseAt(kStart + i * 70'000)), &poses_first);
  }
  for (int i = 0; i < 4; ++i) {
    append(a.AddCloud(CloudAt(kStart + i * 50'000 + 7, i)), &poses_first);
  }
  append(b.AddPose(PoseAt(kStart)), &clouds_first);
  for (int i = 0; i < 4; ++i) {
    append(b.AddCloud(CloudAt(kStart + i * 50'000 + 7, i)), &clouds_first);
  }
  for (int i = 1; i < 5; ++i) append(b.AddPose(PoseAt(kStart + i * 70'000)), &clouds_first);
  ASSERT_EQ(clouds_first.size(), 4u);
  ASSERT_EQ(poses_first.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) ExpectSame(clouds_first[i], poses_first[i]);
}

TEST(CloudPlacerTest, CloudsWithoutAPoseNearbyAreLeftOutAndCounted) {
  CloudPlacer placer(CloudParams(), true);
  placer.AddPose(PoseAt(kStart));
  placer.AddCloud(CloudAt(kStart - 1'000));    // before the first pose
  placer.AddCloud(CloudAt(kStart + 100'000));  // in a gap of a second
  EXPECT_TRUE(placer.AddPose(PoseAt(kStart + 1'000'000)).empty());
  EXPECT_EQ(placer.counters().clouds_without_pose, 2);
  EXPECT_EQ(placer.counters().clouds, 0);
}

TEST(CloudPlacerTest, SilentPosesFillNoMemory) {
  CloudPlacer placer(CloudParams(), true);
  for (int i = 0; i < 100; ++i) placer.AddCloud(CloudAt(kStart + i * 100'000));
  EXPECT_EQ(placer.counters().clouds_without_pose, 92);
}

TEST(CloudPlacerTest, RepeatedAndOlderCloudsAreLeftOutAndAReplayBeginsAnew) {
  CloudPlacer placer(CloudParams(), false);
  EXPECT_EQ(placer.AddCloud(CloudAt(kStart)).size(), 1u);
  EXPECT_TRUE(placer.AddCloud(CloudAt(kStart)).empty());
  EXPECT_TRUE(placer.AddCloud(CloudAt(kStart - 100'000)).empty());
  EXPECT_EQ(placer.counters().unordered_clouds, 2);
  EXPECT_EQ(placer.AddCloud(CloudAt(kStart - 10'000'000)).size(), 1u);
}

TEST(CloudPlacerTest, AReplayOfBothStreamsBeginsAnew) {
  CloudPlacer placer(CloudParams(), true);
  int num_placed = 0;
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i <= 10; ++i) {
      num_placed += static_cast<int>(placer.AddPose(PoseAt(kStart + i * 100'000)).size());
      num_placed += static_cast<int>(placer.AddCloud(CloudAt(kStart + i * 100'000 + 1)).size());
    }
  }
  // The last of each round waits for a pose that never comes.
  EXPECT_EQ(num_placed, 30);
}

TEST(CloudPlacerTest, UnusableInputIsCountedAndChangesNothing) {
  CloudPlacer placer(CloudParams(), true);
  TimedPose pose = PoseAt(kStart);
  pose.T_local_laser.linear()(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(placer.AddPose(pose).empty());
  pose = PoseAt(kStart);
  pose.T_local_laser.translation().x() = 1e300;
  EXPECT_TRUE(placer.AddPose(pose).empty());
  EXPECT_TRUE(placer.AddCloud(CloudAt(std::numeric_limits<std::int64_t>::min())).empty());
  EXPECT_TRUE(placer.AddCloud(CloudAt(std::numeric_limits<std::int64_t>::max())).empty());
  EXPECT_EQ(placer.counters().bad_poses, 2);
  EXPECT_EQ(placer.counters().bad_clouds, 2);
  placer.AddPose(PoseAt(kStart));
  EXPECT_EQ(placer.AddCloud(CloudAt(kStart)).size(), 1u);
}

TEST(CloudPlacerTest, AnEmptyCloudIsAnEmptyScan) {
  CloudPlacer placer(CloudParams(), false);
  const std::vector<PlacedCloud> placed = placer.AddCloud({Time(kStart), {}});
  ASSERT_EQ(placed.size(), 1u);
  EXPECT_TRUE(placed[0].scan.points.empty());
}

TEST(CloudPlacerTest, ParametersOutOfRangeAreRefused) {
  CloudParams params;
  params.mount_z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(Complains([&] { CloudPlacer placer(params, false); }, {"cloud", "mount_z"}));
}

}  // namespace
}  // namespace rimod
