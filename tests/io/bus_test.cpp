#include "io/bus.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

#include "io/bus_params.h"
#include "io/raw_subscription.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

TEST(BusTest, SignalsStopTheLoop) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const StopOnSignal signals;
    lcm::LCM lcm("memq://");
    int num_idle = 0;
    const auto begin = Clock::now();
    EXPECT_TRUE(RunBus(&lcm, signals.stop(), [&num_idle, signal] {
      if (++num_idle == 3) std::raise(signal);
    }));
    EXPECT_EQ(num_idle, 3);
    EXPECT_LT(Clock::now() - begin, std::chrono::seconds(1));
  }
}

TEST(BusTest, ASignalThatInterruptsTheWaitDoesNotEndTheLoop) {
  std::signal(SIGUSR1, [](int) {});
  lcm::LCM lcm("memq://");
  std::atomic<bool> stop = false;
  const pthread_t waiting = pthread_self();
  std::thread other([&stop, waiting] {
    for (int i = 0; i < 60; ++i) {
      pthread_kill(waiting, SIGUSR1);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    stop = true;
  });
  EXPECT_TRUE(RunBus(&lcm, stop, [] {}));
  other.join();
}

TEST(BusTest, IdleIsCalledAlsoWhileMessagesKeepComing) {
  lcm::LCM lcm("memq://");
  std::atomic<bool> stop = false;
  const BytesSubscription echo(&lcm, "A", 10, {},
                               [&lcm](const void*, std::size_t) { lcm.publish("A", "x", 1); });
  lcm.publish("A", "x", 1);
  int num_idle = 0;
  const auto begin = Clock::now();
  RunBus(&lcm, stop, [&num_idle, &stop] { stop = ++num_idle == 5; });
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(2));
}

TEST(BusTest, AnInstanceThatFailsAgainAndAgainEndsTheLoop) {
  lcm::LCM lcm("nonsense://");
  std::atomic<bool> stop = false;
  EXPECT_FALSE(RunBus(&lcm, stop, [] {}));
}

TEST(BusParamsTest, BadValuesAreNamed) {
  BusParams params;
  EXPECT_NO_THROW(params.Validate());
  params.max_waiting_scans = 0;
  try {
    params.Validate();
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("max_waiting_scans"), std::string::npos);
  }
  params = BusParams();
  params.shard_patience = 0.0;
  EXPECT_THROW(params.Validate(), std::invalid_argument);
}

}  // namespace
}  // namespace rimod
