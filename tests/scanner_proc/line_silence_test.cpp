#include "scanner_proc/line_silence.h"

#include <gtest/gtest.h>

#include <random>

namespace rimod {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kQuiet(80);

class LineSilenceTest : public ::testing::Test {
 protected:
  // Time passes; the process looks every ten milliseconds. True when lines seemed to have stopped.
  bool Wait(int duration_ms, bool line_waits = false) {
    bool stopped = false;
    for (int ms = 1; ms <= duration_ms; ++ms) {
      now_ += milliseconds(1);
      if (++since_look_ < 10) continue;
      since_look_ = 0;
      silence_.Look(now_);
      stopped = stopped || silence_.LinesStopped(line_waits);
    }
    return stopped;
  }
  void Line() {
    silence_.OnLine(now_, first_);
    first_ = false;
  }

  LineSilence::Clock::time_point now_ = LineSilence::Clock::time_point(std::chrono::hours(1));
  LineSilence silence_{kQuiet, now_};
  bool first_ = true;
  int since_look_ = 0;
};

TEST_F(LineSilenceTest, SteadyLinesStopAfterThreePeriods) {
  for (int line = 0; line < 100; ++line) {
    Line();
    EXPECT_FALSE(Wait(27)) << line;
  }
  EXPECT_FALSE(Wait(80 - 27));
  EXPECT_TRUE(Wait(30));
}

TEST_F(LineSilenceTest, ALineAtTheQuietTimeOfFastLinesGoesOn) {
  for (int line = 0; line < 100; ++line) {
    Line();
    EXPECT_FALSE(Wait(line == 50 ? 75 : 5)) << line;
  }
  EXPECT_FALSE(Wait(200)) << "a pause of 75 ms was before";
  EXPECT_TRUE(Wait(40));
}

TEST_F(LineSilenceTest, BurstsAreNoStop) {
  for (int burst = 0; burst < 20; ++burst) {
    for (int line = 0; line < 10; ++line) Line();
    EXPECT_FALSE(Wait(burst == 0 ? 70 : 200)) << burst;
  }
}

TEST_F(LineSilenceTest, PausesThatVaryAreNoStop) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> pause(10, 75);
  for (int line = 0; line < 1000; ++line) {
    Line();
    EXPECT_FALSE(Wait(pause(random))) << line;
  }
}

TEST_F(LineSilenceTest, WhileThisProcessDoesNotRunThereIsNoSilence) {
  for (int line = 0; line < 50; ++line) {
    Line();
    EXPECT_FALSE(Wait(27));
  }
  now_ += milliseconds(500);  // stood still
  EXPECT_FALSE(Wait(40)) << "what came meanwhile may still be on its way here";
  EXPECT_TRUE(Wait(60));
}

TEST_F(LineSilenceTest, PosesThatGoOnAreNoLines) {
  for (int line = 0; line < 50; ++line) {
    Line();
    EXPECT_FALSE(Wait(27));
  }
  bool stopped = false;
  for (int pose = 0; pose < 20; ++pose) {
    silence_.OnInput(now_);
    stopped = stopped || Wait(10);
  }
  EXPECT_TRUE(stopped);
}

TEST_F(LineSilenceTest, ALineThatWaitsForItsPoseIsWaitedFor) {
  for (int line = 0; line < 50; ++line) {
    Line();
    EXPECT_FALSE(Wait(27));
  }
  for (int pose = 0; pose < 20; ++pose) {
    silence_.OnInput(now_);
    EXPECT_FALSE(Wait(10, /*line_waits=*/true));
  }
  EXPECT_TRUE(Wait(100, /*line_waits=*/true)) << "but not for ever";
}

TEST_F(LineSilenceTest, ThePauseBeforeASweepIsForgotten) {
  Line();
  Wait(3000);
  first_ = true;
  for (int line = 0; line < 20; ++line) {
    Line();
    Wait(27);
  }
  EXPECT_TRUE(Wait(80));
}

}  // namespace
}  // namespace rimod
