#include "io/laser_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bot_core/image_t.hpp"
#include "bot_core/pointcloud2_t.hpp"
#include "bot_core/pose_t.hpp"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(LaserMessagesTest, ALineComesBack) {
  LaserLine line;
  line.time = Time(1234567890123456);
  line.first_angle = -1.5;
  line.angle_step = 0.0078125;
  line.ranges = {1.5f, 81.91f, 0.0f, -1.0f};
  const LaserLineFromMessage received = FromMessage(ToMessage(line));
  ASSERT_TRUE(received.line) << received.error;
  EXPECT_EQ(received.line->time, line.time);
  EXPECT_EQ(received.line->first_angle, line.first_angle);
  EXPECT_EQ(received.line->angle_step, line.angle_step);
  EXPECT_EQ(received.line->ranges, line.ranges);
}

TEST(LaserMessagesTest, RangesThatAreNotFiniteAreLeftToTheAssembler) {
  bot_core::planar_lidar_t message = {};
  message.nranges = 2;
  message.ranges = {1.0f, kNaN};
  const LaserLineFromMessage received = FromMessage(message);
  ASSERT_TRUE(received.line);
  EXPECT_TRUE(std::isnan(received.line->ranges[1]));
}

TEST(LaserMessagesTest, BadLinesAreRejected) {
  bot_core::planar_lidar_t good = {};
  good.nranges = 2;
  good.ranges = {1.0f, 2.0f};
  ASSERT_TRUE(FromMessage(good).line);

  bot_core::planar_lidar_t bad = good;
  bad.nranges = 3;
  EXPECT_EQ(FromMessage(bad).error, "a count does not fit its list");
  bad.nranges = -1;
  EXPECT_EQ(FromMessage(bad).error, "a count does not fit its list");
  bad = good;
  bad.nintensities = 1;
  EXPECT_EQ(FromMessage(bad).error, "a count does not fit its list");
  bad = good;
  bad.rad0 = kNaN;
  EXPECT_EQ(FromMessage(bad).error, "an angle is not finite");
  bad = good;
  bad.radstep = std::numeric_limits<float>::infinity();
  EXPECT_EQ(FromMessage(bad).error, "an angle is not finite");
  EXPECT_EQ(FromMessage(bot_core::planar_lidar_t{}).error, "a line without a beam");
}

TEST(LaserMessagesTest, APoseComesBack) {
  RandomValues random(1);
  const TimedPose pose = {Time(77), random.Pose()};
  const TimedPoseFromMessage received = FromMessage(ToMessage(pose));
  ASSERT_TRUE(received.pose) << received.error;
  EXPECT_EQ(received.pose->time, pose.time);
  EXPECT_TRUE(received.pose->T_local_laser.isApprox(pose.T_local_laser, 1e-13));
}

TEST(LaserMessagesTest, BadPosesAreRejected) {
  EXPECT_EQ(FromMessage(bot_core::rigid_transform_t{}).error, "not a pose");
  bot_core::rigid_transform_t message = ToMessage(TimedPose{});
  ASSERT_TRUE(FromMessage(message).pose);
  message.trans[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(FromMessage(message).pose);
}

// The published ones of libbot2: only then do its modules and ours understand each other.
TEST(LaserMessagesTest, StandardTypesHaveTheirFingerprints) {
  const auto fingerprint = [](std::int64_t hash) { return static_cast<std::uint64_t>(hash); };
  EXPECT_EQ(fingerprint(bot_core::planar_lidar_t::getHash()), 0xe3d17423180b5e8dULL);
  EXPECT_EQ(fingerprint(bot_core::rigid_transform_t::getHash()), 0xea9ffbf2acc5c5aeULL);
  EXPECT_EQ(fingerprint(bot_core::pose_t::getHash()), 0x2e16efb052b0105eULL);
  EXPECT_EQ(fingerprint(bot_core::image_t::getHash()), 0x14739ffe13d5f5f0ULL);
  EXPECT_EQ(fingerprint(bot_core::pointcloud2_t::getHash()), 0x0bcd5ce4bf5a1b4aULL);
}

}  // namespace
}  // namespace rimod
