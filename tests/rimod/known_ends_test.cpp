#include "rimod/known_ends.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace rimod {
namespace {

constexpr double kTurn = 0.01;  // rad, of a line

// A sweep of num_lines lines from this tilt on; returns the lines at which its end seemed reached.
std::vector<std::size_t> Sweep(KnownEnds* ends, int direction, double first_tilt,
                               std::size_t num_lines) {
  std::vector<std::size_t> reached;
  ends->Begin();
  double tilt = first_tilt;
  for (std::size_t line = 0; line < num_lines; ++line) {
    ends->Follow(direction, tilt, tilt + direction * kTurn, line);
    tilt += direction * kTurn;
    if (ends->ReachedWith(line)) reached.push_back(line);
  }
  ends->Learn(direction, tilt, num_lines - 1);
  return reached;
}

using Lines = std::vector<std::size_t>;

TEST(KnownEndsTest, AnEndIsKnownWhenThreeSweepsEndedThere) {
  KnownEnds ends;
  for (int sweep = 0; sweep < 3; ++sweep) EXPECT_EQ(Sweep(&ends, 1, -0.5, 100), Lines{});
  for (int sweep = 0; sweep < 3; ++sweep) EXPECT_EQ(Sweep(&ends, 1, -0.5, 100), Lines{99});
}

TEST(KnownEndsTest, EachDirectionHasItsOwn) {
  KnownEnds ends;
  for (int sweep = 0; sweep < 3; ++sweep) {
    EXPECT_EQ(Sweep(&ends, 1, -0.5, 100), Lines{});
    EXPECT_EQ(Sweep(&ends, -1, 0.5, 90), Lines{});
  }
  EXPECT_EQ(Sweep(&ends, 1, -0.5, 100), Lines{99});
  EXPECT_EQ(Sweep(&ends, -1, 0.5, 90), Lines{89});
}

TEST(KnownEndsTest, WhereTheSweepBeganDoesNotMatter) {
  KnownEnds ends;
  Sweep(&ends, 1, -0.5, 100);
  Sweep(&ends, 1, -0.3, 80);
  Sweep(&ends, 1, -0.6, 110);
  EXPECT_EQ(Sweep(&ends, 1, -0.4, 90), Lines{89});
}

TEST(KnownEndsTest, ASweepThatGoesOnIsLearntAnew) {
  KnownEnds ends;
  for (int sweep = 0; sweep < 3; ++sweep) Sweep(&ends, 1, -0.5, 100);
  EXPECT_EQ(Sweep(&ends, 1, -0.5, 120), Lines{99});
  for (int sweep = 0; sweep < 2; ++sweep) EXPECT_EQ(Sweep(&ends, 1, -0.5, 120), Lines{});
  EXPECT_EQ(Sweep(&ends, 1, -0.5, 120), Lines{119});
}

TEST(KnownEndsTest, AShorterSweepDoesNotReachIt) {
  KnownEnds ends;
  for (int sweep = 0; sweep < 3; ++sweep) Sweep(&ends, 1, -0.5, 100);
  EXPECT_EQ(Sweep(&ends, 1, -0.5, 98), Lines{});
}

TEST(KnownEndsTest, EndsThatVaryByMoreThanHalfALineAreNeverKnown) {
  KnownEnds ends;
  for (int sweep = 0; sweep < 20; ++sweep)
    EXPECT_EQ(Sweep(&ends, 1, -0.5, sweep % 2 == 0 ? 100 : 102), Lines{}) << sweep;
}

TEST(KnownEndsTest, ATiltThatPassesHalfATurnIsTheSame) {
  KnownEnds ends;
  const double end = 3.0 + 100 * kTurn;  // beyond pi
  for (int sweep = 0; sweep < 3; ++sweep) Sweep(&ends, 1, 3.0, 100);
  EXPECT_EQ(Sweep(&ends, 1, end - 2.0 * M_PI - 100 * kTurn, 100), Lines{99});
}

}  // namespace
}  // namespace rimod
