#include "io/stage_timer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace rimod {
namespace {

TEST(StageTimerTest, StagesKeepTheirOrderAndAddUp) {
  Execution execution;
  StageTimer timer;
  timer.Watch(&execution);
  for (const char* stage : {"matching", "scoring", "matching"}) {
    const StageScope scope(execution, stage);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ASSERT_EQ(timer.times().size(), 2u);
  EXPECT_EQ(timer.times()[0].first, "matching");
  EXPECT_GE(timer.times()[0].second, 4.0);
  EXPECT_EQ(timer.times()[1].first, "scoring");
  EXPECT_GE(timer.times()[1].second, 2.0);
  timer.Reset();
  EXPECT_TRUE(timer.times().empty());
}

}  // namespace
}  // namespace rimod
