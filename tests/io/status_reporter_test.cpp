#include "io/status_reporter.h"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <ctime>
#include <lcm/lcm-cpp.hpp>
#include <thread>

#include "io/message_codec.h"
#include "io/raw_subscription.h"
#include "io/status_counters.h"
#include "io/version.h"

namespace rimod {
namespace {

std::int64_t CounterOf(const status_t& status, const std::string& name) {
  for (const counter_t& counter : status.counters) {
    if (counter.name == name) return counter.value;
  }
  return -1;
}

class StatusReporterTest : public ::testing::Test {
 protected:
  StatusReporterTest() : lcm_("memq://"), reporter_(&lcm_, "RIMOD_STATUS", "rimod-test") {}
  lcm::LCM lcm_;
  StatusReporter reporter_;
};

TEST_F(StatusReporterTest, SaysWhoItIs) {
  const status_t status = reporter_.Snapshot();
  EXPECT_EQ(status.process, "rimod-test");
  EXPECT_EQ(status.version, Version());
  EXPECT_EQ(status.pid, getpid());
  EXPECT_FALSE(status.host.empty());
  EXPECT_EQ(status.last_error, "");
}

TEST_F(StatusReporterTest, TellsWhatTheProcessTakesOfTheMachine) {
  const std::int64_t before = CounterOf(reporter_.Snapshot(), kCpuCounter);
  const auto end = std::clock() + CLOCKS_PER_SEC / 10;
  while (std::clock() < end) {
  }
  const std::vector<char> ballast(20'000'000, 'x');
  const status_t status = reporter_.Snapshot();
  EXPECT_GE(CounterOf(status, kCpuCounter), before + 80);
  EXPECT_GE(CounterOf(status, kMemoryCounter), static_cast<int>(ballast.size() / 1024));
  EXPECT_GE(CounterOf(status, kPeakMemoryCounter), CounterOf(status, kMemoryCounter));
}

TEST_F(StatusReporterTest, GaugesMayFallCountersDoNot) {
  for (const int value : {5, 3}) {
    reporter_.SetGauge("waiting", value);
    reporter_.SetCounter("lines", value);
  }
  EXPECT_EQ(CounterOf(reporter_.Snapshot(), "waiting"), 3);
  EXPECT_EQ(CounterOf(reporter_.Snapshot(), "lines"), 5);
}

TEST_F(StatusReporterTest, CountsByCause) {
  reporter_.CountIn();
  reporter_.CountIn();
  reporter_.CountOut();
  reporter_.CountDropped("scans_overtaken", 3);
  reporter_.CountRejected("LASER", "is empty");
  reporter_.CountRejected("LASER", "is empty");
  reporter_.CountRejected("RIMOD_SCAN", "is empty");
  reporter_.SetCounter("lines", 70);
  reporter_.SetCounter("incomplete", 4, true);
  reporter_.SetCounter("incomplete", 6, true);
  const status_t status = reporter_.Snapshot();
  EXPECT_EQ(status.num_in, 2);
  EXPECT_EQ(status.num_out, 1);
  EXPECT_EQ(status.num_dropped, 9);
  EXPECT_EQ(status.num_rejected, 3);
  EXPECT_EQ(CounterOf(status, "dropped scans_overtaken"), 3);
  EXPECT_EQ(CounterOf(status, "rejected LASER: is empty"), 2);
  EXPECT_EQ(CounterOf(status, "rejected RIMOD_SCAN: is empty"), 1);
  EXPECT_EQ(CounterOf(status, "lines"), 70);
  EXPECT_EQ(CounterOf(status, "dropped incomplete"), 6);
  EXPECT_EQ(status.last_error, "message on RIMOD_SCAN rejected: is empty");
}

TEST_F(StatusReporterTest, StageTimesAreMediansInOrderOfTheStages) {
  for (const double ms : {30.0, 10.0, 20.0}) reporter_.AddStageTimes({{"b", ms}, {"a", 2 * ms}});
  const status_t status = reporter_.Snapshot();
  ASSERT_EQ(status.num_stage_times, 2);
  EXPECT_EQ(status.stage_times[0].stage, "b");
  EXPECT_EQ(status.stage_times[0].ms, 20.0);
  EXPECT_EQ(status.stage_times[1].stage, "a");
  EXPECT_EQ(status.stage_times[1].ms, 40.0);
}

TEST_F(StatusReporterTest, OldScansLeaveTheMedian) {
  for (int i = 0; i < 50; ++i) reporter_.AddStageTimes({{"a", 1.0}});
  for (int i = 0; i < 20; ++i) reporter_.AddStageTimes({{"a", 5.0}});
  EXPECT_EQ(reporter_.Snapshot().stage_times[0].ms, 5.0);
}

TEST_F(StatusReporterTest, EndlesslyManyCausesStayBounded) {
  spdlog::set_level(spdlog::level::off);
  for (int i = 0; i < 5000; ++i) {
    reporter_.CountRejected("LASER", std::to_string(i) + std::string(1000, 'x'));
    reporter_.AddStageTimes({{std::to_string(i), 1.0}});
  }
  spdlog::set_level(spdlog::level::info);
  const status_t status = reporter_.Snapshot();
  EXPECT_EQ(status.num_rejected, 5000);
  EXPECT_LE(EncodeMessage(status).size(), static_cast<std::size_t>(kSectionBytes));
}

TEST_F(StatusReporterTest, GoesOutOnceASecond) {
  std::vector<status_t> received;
  const auto subscription =
      SubscribeTo<status_t>(&lcm_, "RIMOD_STATUS", 10, {}, [&received](const status_t& status) {
        received.push_back(status);
        return "";
      });
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(1500);
  while (std::chrono::steady_clock::now() < end) {
    reporter_.PublishIfDue();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  while (lcm_.handleTimeout(0) > 0) {
  }
  EXPECT_EQ(received.size(), 2u);
  EXPECT_EQ(received.at(0).process, "rimod-test");
  EXPECT_GT(received.at(1).utime, received.at(0).utime);
}

TEST_F(StatusReporterTest, ManyThreadsMayCount) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([this] {
      for (int k = 0; k < 1000; ++k) {
        reporter_.CountIn();
        reporter_.CountDropped("x");
        reporter_.AddStageTimes({{"a", 1.0}});
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(reporter_.Snapshot().num_in, 4000);
  EXPECT_EQ(CounterOf(reporter_.Snapshot(), "dropped x"), 4000);
}

}  // namespace
}  // namespace rimod
