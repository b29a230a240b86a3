#include "io/paced_publisher.h"

#include <gtest/gtest.h>

#include "io/raw_subscription.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

class PacedPublisherTest : public ::testing::Test {
 protected:
  PacedPublisherTest() : lcm_("memq://") {
    params_.max_megabytes_per_second = 10.0;
    subscription_ = std::make_unique<BytesSubscription>(
        &lcm_, "CHANNEL", 1000, SubscriptionObserver(),
        [this](const void* bytes, std::size_t size) {
          received_.emplace_back(static_cast<const std::uint8_t*>(bytes)[0], size);
        });
  }
  void HandleAll() {
    while (lcm_.handleTimeout(0) > 0) {
    }
  }
  lcm::LCM lcm_;
  BusParams params_;
  std::unique_ptr<BytesSubscription> subscription_;
  std::vector<std::pair<int, std::size_t>> received_;  // first byte and size
};

TEST_F(PacedPublisherTest, MessagesGoOutInOrder) {
  PacedPublisher publisher(&lcm_, params_);
  for (int i = 0; i < 50; ++i) {
    publisher.PublishBytes("CHANNEL", {static_cast<std::uint8_t>(i)});
  }
  publisher.Flush();
  HandleAll();
  ASSERT_EQ(received_.size(), 50u);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(received_[static_cast<std::size_t>(i)].first, i);
}

TEST_F(PacedPublisherTest, ABurstTakesAsLongAsTheRateSaysAndNotMuchLonger) {
  PacedPublisher publisher(&lcm_, params_);
  const auto begin = Clock::now();
  for (int i = 0; i < 20; ++i) publisher.PublishBytes("CHANNEL", std::vector<std::uint8_t>(100000));
  EXPECT_LT(Clock::now() - begin, std::chrono::milliseconds(100)) << "the caller had to wait";
  publisher.Flush();
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  EXPECT_GE(seconds, 0.185);  // 1.9 MB at 10 MB/s after the first 0.1 MB
  EXPECT_LE(seconds, 0.6);
}

TEST_F(PacedPublisherTest, SlowlyTakesTwiceAsLong) {
  PacedPublisher publisher(&lcm_, params_);
  const auto begin = Clock::now();
  for (int i = 0; i < 10; ++i)
    publisher.PublishBytes("CHANNEL", std::vector<std::uint8_t>(100000), /*slowness=*/2);
  publisher.Flush();
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  EXPECT_GE(seconds, 0.175);  // 0.9 MB at 5 MB/s after the first 0.1 MB
  HandleAll();
  EXPECT_EQ(received_.size(), 10u);
}

TEST_F(PacedPublisherTest, ASingleMessageGoesOutAtOnce) {
  PacedPublisher publisher(&lcm_, params_);
  const auto begin = Clock::now();
  publisher.PublishBytes("CHANNEL", std::vector<std::uint8_t>(60000));
  publisher.Flush();
  EXPECT_LT(Clock::now() - begin, std::chrono::milliseconds(100));
}

TEST_F(PacedPublisherTest, WhatIsQueuedAtTheEndIsStillSent) {
  {
    PacedPublisher publisher(&lcm_, params_);
    for (int i = 0; i < 10; ++i) {
      publisher.PublishBytes("CHANNEL", std::vector<std::uint8_t>(100000));
    }
  }
  HandleAll();
  EXPECT_EQ(received_.size(), 10u);
}

TEST_F(PacedPublisherTest, TheEndIsNeverFar) {
  params_.max_megabytes_per_second = 0.1;
  const auto begin = Clock::now();
  {
    PacedPublisher publisher(&lcm_, params_);
    for (int i = 0; i < 100; ++i) {
      publisher.PublishBytes("CHANNEL", std::vector<std::uint8_t>(60000));
    }
  }
  EXPECT_LT(Clock::now() - begin, std::chrono::milliseconds(1000));
}

}  // namespace
}  // namespace rimod
