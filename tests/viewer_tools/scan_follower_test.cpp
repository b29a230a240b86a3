#include "viewer_tools/scan_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "io/feature_messages.h"
#include "io/message_codec.h"
#include "io/partial_messages.h"
#include "io/range_image_messages.h"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

class ScanFollowerTest : public testing::Test {
 protected:
  template <typename Message>
  std::string Send(const std::string& channel, const Message& message) {
    const std::vector<std::uint8_t> bytes = EncodeMessage(message);
    return follower_.Take(channel, bytes.data(), bytes.size(), now_);
  }
  template <typename Message>
  void SendAll(const std::string& channel, const std::vector<Message>& messages) {
    for (const Message& message : messages) EXPECT_EQ(Send(channel, message), "");
  }
  void SendImage(std::int64_t utime) {
    SendAll(channels_.range_image, ToSections(RandomValues(1).AnImage(300, 200), utime));
  }
  void SendDetections(std::int64_t utime) {
    StampedDetections detections;
    detections.utime = utime;
    detections.detections.resize(2);
    for (Detection& detection : detections.detections) detection.class_name = "fan";
    EXPECT_EQ(Send(channels_.detections, ToMessage(detections)), "");
  }
  StampedEarlyObjects Early(std::int64_t utime, std::int64_t known_until) {
    StampedEarlyObjects early;
    early.utime = utime;
    early.known_until = known_until;
    early.objects.resize(1);
    early.objects[0].detection.class_name = "fan";
    return early;
  }

  Channels channels_;
  ScanFollower follower_{channels_, BusParams()};
  ScanFollower::Clock now_{std::chrono::seconds(1)};
};

TEST_F(ScanFollowerTest, BringsThePartsOfAScanTogetherInAnyOrder) {
  EXPECT_EQ(follower_.newest(), nullptr);
  SendDetections(7);
  SendAll(channels_.features, ToSections(RandomValues(2).Features(3, 8), 7));
  EXPECT_EQ(follower_.newest(), nullptr);
  std::vector<range_image_t> sections = ToSections(RandomValues(1).AnImage(300, 200), 7);
  ASSERT_GT(sections.size(), 1u);
  std::reverse(sections.begin(), sections.end());
  SendAll(channels_.range_image, sections);
  ASSERT_NE(follower_.newest(), nullptr);
  EXPECT_EQ(follower_.newest()->utime, 7);
  EXPECT_EQ(follower_.newest()->image->width(), 300);
  EXPECT_EQ(follower_.newest()->features->features.size(), 3u);
  EXPECT_EQ(follower_.newest()->detections->detections.size(), 2u);
}

TEST_F(ScanFollowerTest, TheNewestImageWins) {
  SendImage(7);
  const std::int64_t version = follower_.newest_version();
  SendImage(5);  // as in a log that is played again
  EXPECT_EQ(follower_.newest()->utime, 5);
  EXPECT_NE(follower_.newest_version(), version);
  SendDetections(7);
  EXPECT_EQ(follower_.newest()->utime, 5);
  EXPECT_FALSE(follower_.newest()->detections);
}

TEST_F(ScanFollowerTest, ScansAreFinishedWithTheirDetections) {
  SendImage(7);
  EXPECT_TRUE(follower_.TakeFinished().empty());
  SendDetections(7);
  SendDetections(8);  // no image of it
  const std::vector<ViewedScan> finished = follower_.TakeFinished();
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_EQ(finished[0].utime, 7);
  EXPECT_TRUE(follower_.TakeFinished().empty());
  SendImage(9);
  const std::vector<ViewedScan> rest = follower_.TakeRest();
  ASSERT_EQ(rest.size(), 1u);
  EXPECT_EQ(rest[0].utime, 9);
}

TEST_F(ScanFollowerTest, WhatIsToldEarlyStaysUntilTheScanSaysMore) {
  SendAll(channels_.partial_range_image, ToPartialSections(RandomValues(1).AnImage(30, 20), 7, 8));
  EXPECT_TRUE(follower_.newest()->is_partial());
  EXPECT_EQ(Send(channels_.early_detections, ToMessage(Early(7, 8))), "");
  EXPECT_EQ(follower_.newest()->early->objects.size(), 1u);
  EXPECT_EQ(follower_.TakeFinished().size(), 1u);
  SendImage(7);
  EXPECT_FALSE(follower_.newest()->is_partial());
  ASSERT_TRUE(follower_.newest()->early);
  EXPECT_EQ(follower_.newest()->early->objects.size(), 1u);
}

TEST_F(ScanFollowerTest, AScanSentOnceMoreForgetsWhatWasFoundInTheShorterOne) {
  SendImage(7);
  SendDetections(7);
  now_ += std::chrono::seconds(1);
  SendImage(7);
  EXPECT_FALSE(follower_.newest()->detections);
}

TEST_F(ScanFollowerTest, DamagedMessagesAreNamedAndHarmless) {
  SendImage(7);
  std::vector<std::uint8_t> bytes =
      EncodeMessage(ToSections(RandomValues(1).AnImage(30, 20), 9)[0]);
  for (const std::string& channel : follower_.channel_names()) {
    EXPECT_NE(follower_.Take(channel, bytes.data(), bytes.size() / 2, now_), "");
    EXPECT_NE(follower_.Take(channel, bytes.data(), 0, now_), "");
  }
  EXPECT_EQ(follower_.Take("OTHER", bytes.data(), 3, now_), "");
  EXPECT_EQ(follower_.newest()->utime, 7);
}

TEST_F(ScanFollowerTest, ManyUnknownScansDoNotFillTheMemory) {
  for (int i = 0; i < 1000; ++i) SendDetections(100 + i);
  SendImage(7);
  for (int i = 0; i < 1000; ++i) SendDetections(5000 + i);
  ASSERT_NE(follower_.newest(), nullptr);
  EXPECT_EQ(follower_.newest()->utime, 7);
  EXPECT_LE(follower_.TakeRest().size(), 8u);
}

}  // namespace
}  // namespace rimod
