#include "io/raw_subscription.h"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

#include "io/laser_messages.h"

namespace rimod {
namespace {

class RawSubscriptionTest : public ::testing::Test {
 protected:
  RawSubscriptionTest() : lcm_("memq://") {
    observer_.on_received = [this](const std::string&) { ++num_received_; };
    observer_.on_rejected = [this](const std::string& channel, const std::string& cause) {
      ++rejected_[channel + ": " + cause];
    };
  }
  void HandleAll() {
    while (lcm_.handleTimeout(0) > 0) {
    }
  }
  void PublishBytes(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    lcm_.publish(channel, bytes.data(), static_cast<unsigned int>(bytes.size()));
  }

  lcm::LCM lcm_;
  SubscriptionObserver observer_;
  int num_received_ = 0;
  std::map<std::string, int> rejected_;
};

bot_core::rigid_transform_t Pose(std::int64_t utime) {
  return ToMessage(TimedPose{Time(utime), Eigen::Isometry3d::Identity()});
}

TEST_F(RawSubscriptionTest, GoodMessagesArriveDecoded) {
  std::vector<std::int64_t> utimes;
  const auto subscription = SubscribeTo<bot_core::rigid_transform_t>(
      &lcm_, "POSE", 10, observer_, [&utimes](const bot_core::rigid_transform_t& message) {
        utimes.push_back(message.utime);
        return "";
      });
  for (const std::int64_t utime : {5, 6}) PublishBytes("POSE", EncodeMessage(Pose(utime)));
  HandleAll();
  EXPECT_EQ(utimes, (std::vector<std::int64_t>{5, 6}));
  EXPECT_EQ(num_received_, 2);
  EXPECT_TRUE(rejected_.empty());
}

TEST_F(RawSubscriptionTest, BadMessagesAreCountedByCauseAndTheNextGoodOneArrives) {
  int num_good = 0;
  const auto subscription = SubscribeTo<bot_core::rigid_transform_t>(
      &lcm_, "POSE", 10, observer_, [&num_good](const bot_core::rigid_transform_t&) {
        ++num_good;
        return "";
      });
  std::vector<std::uint8_t> bytes = EncodeMessage(Pose(1));
  bytes.pop_back();
  PublishBytes("POSE", bytes);
  PublishBytes("POSE", {});
  PublishBytes("POSE", EncodeMessage(bot_core::planar_lidar_t{}));
  PublishBytes("POSE", EncodeMessage(Pose(1)));
  HandleAll();
  EXPECT_EQ(num_good, 1);
  EXPECT_EQ(num_received_, 4);
  EXPECT_EQ(rejected_,
            (std::map<std::string, int>{
                {"POSE: is cut off", 1}, {"POSE: is empty", 1}, {"POSE: is of another type", 1}}));
}

TEST_F(RawSubscriptionTest, WhatAHandlerRefusesOrThrowsIsCounted) {
  int num_calls = 0;
  const auto subscription = SubscribeTo<bot_core::rigid_transform_t>(
      &lcm_, "POSE", 10, observer_,
      [&num_calls](const bot_core::rigid_transform_t& message) -> std::string {
        ++num_calls;
        if (message.utime == 1) return "not wanted";
        if (message.utime == 2) throw std::runtime_error("thrown");
        return "";
      });
  for (const std::int64_t utime : {1, 2, 3}) {
    PublishBytes("POSE", EncodeMessage(Pose(utime)));
    HandleAll();  // would abort were LCM left locked
  }
  EXPECT_EQ(num_calls, 3);
  EXPECT_EQ(rejected_, (std::map<std::string, int>{{"POSE: not wanted", 1}, {"POSE: thrown", 1}}));
}

TEST_F(RawSubscriptionTest, ChannelNamesAreTakenLiterally) {
  int num_received = 0;
  const auto subscription = SubscribeTo<bot_core::rigid_transform_t>(
      &lcm_, "ROBOT.1+(POSE)", 10, observer_, [&num_received](const bot_core::rigid_transform_t&) {
        ++num_received;
        return "";
      });
  PublishBytes("ROBOTx1+(POSE)", EncodeMessage(Pose(1)));
  PublishBytes("ROBOT.1POSE", EncodeMessage(Pose(1)));
  PublishBytes("ROBOT.1+(POSE)", EncodeMessage(Pose(1)));
  HandleAll();
  EXPECT_EQ(num_received, 1);
}

TEST_F(RawSubscriptionTest, NothingArrivesAfterItsEnd) {
  int num_received = 0;
  auto subscription = SubscribeTo<bot_core::rigid_transform_t>(
      &lcm_, "POSE", 10, observer_, [&num_received](const bot_core::rigid_transform_t&) {
        ++num_received;
        return "";
      });
  PublishBytes("POSE", EncodeMessage(Pose(1)));
  subscription.reset();
  HandleAll();
  EXPECT_EQ(num_received, 0);
}

}  // namespace
}  // namespace rimod
