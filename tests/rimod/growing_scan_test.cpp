#include "rimod/growing_scan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "rimod/sweep_assembler.h"
#include "tests/io/random_values.h"
#include "tests/support/matchers.h"

namespace rimod {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr std::int64_t kLinePeriod = 26670;  // us

// Tilts to and fro by 25 degrees, 100 lines each way, with rests of 30 lines at the ends.
double TiltAt(int line) {
  const int phase = line % 260;
  if (phase < 30) return 0.0;
  if (phase < 130) return 0.25 * kDegree * (phase - 30);
  if (phase < 160) return 25.0 * kDegree;
  return 0.25 * kDegree * (260 - phase);
}

struct Recorded {
  std::vector<Sweep> sweeps;
  std::vector<SweepGrowth> growths;
};

// num_lines lines of random ranges; growths are taken every period (s), never when it is 0.
Recorded Record(int num_lines, double period) {
  RandomValues random(1);
  SweepAssembler assembler{SweepParams()};
  Recorded recorded;
  const auto add = [&](std::vector<Sweep> ended) {
    for (Sweep& sweep : ended) recorded.sweeps.push_back(std::move(sweep));
    if (period == 0.0) return;
    const std::optional<SweepGrowth> growth = assembler.TakeGrowth(period);
    if (growth) recorded.growths.push_back(*growth);
  };
  for (int i = 0; i <= num_lines; ++i) {
    TimedPose pose;
    pose.time = Time(i * kLinePeriod);
    pose.T_local_laser.linear() =
        Eigen::AngleAxisd(TiltAt(i), Eigen::Vector3d::UnitY()).toRotationMatrix();
    pose.T_local_laser.translation() = Eigen::Vector3d(0.001 * i, 0.0, 1.0);
    add(assembler.AddPose(pose));
    LaserLine line;
    line.time = pose.time;
    line.first_angle = -1.5;
    line.angle_step = 0.1;
    for (int beam = 0; beam < 31; ++beam)
      line.ranges.push_back(random.Int(0, 9) == 0 ? 81.91f
                                                  : static_cast<float>(random.Between(1.0, 9.0)));
    if (i < num_lines) add(assembler.AddLine(line));
  }
  add(assembler.Finish());
  return recorded;
}

void ExpectBeginsWith(const std::vector<Eigen::Vector3f>& whole,
                      const std::vector<Eigen::Vector3f>& part) {
  ASSERT_LE(part.size(), whole.size());
  EXPECT_TRUE(std::equal(part.begin(), part.end(), whole.begin()));
}

TEST(SweepGrowthTest, SweepsDoNotDependOnWhetherGrowthIsTaken) {
  const Recorded without = Record(800, 0.0), with = Record(800, 0.3);
  ASSERT_GE(without.sweeps.size(), 5u);
  ASSERT_EQ(without.sweeps.size(), with.sweeps.size());
  EXPECT_GT(with.growths.size(), 20u);
  for (std::size_t i = 0; i < without.sweeps.size(); ++i) {
    EXPECT_EQ(without.sweeps[i].begin, with.sweeps[i].begin);
    EXPECT_EQ(without.sweeps[i].end, with.sweeps[i].end);
    EXPECT_EQ(without.sweeps[i].scan.points, with.sweeps[i].scan.points);
    EXPECT_EQ(without.sweeps[i].scan.no_return_directions,
              with.sweeps[i].scan.no_return_directions);
    EXPECT_EQ(without.sweeps[i].scan.T_local_sensor.matrix(),
              with.sweeps[i].scan.T_local_sensor.matrix());
  }
}

TEST(SweepGrowthTest, AllGrowthsOfASweepAreItsBeginning) {
  const Recorded recorded = Record(800, 0.3);
  std::size_t num_followed = 0;
  for (const Sweep& sweep : recorded.sweeps) {
    if (!sweep.complete()) continue;
    GrowingScan growing;
    int step = 0;
    Time known_until = sweep.begin;
    for (const SweepGrowth& growth : recorded.growths) {
      if (growth.sweep_begin != sweep.begin) continue;
      EXPECT_EQ(growth.step, step++);
      EXPECT_GE(growth.begin, known_until);
      EXPECT_GE(growth.end - growth.begin, Time(300'000));
      known_until = growth.end;
      ASSERT_TRUE(growing.Add(growth));
      EXPECT_EQ(growing.end(), growth.end);
      ExpectBeginsWith(sweep.scan.points, growing.scan()->points);
      ExpectBeginsWith(sweep.scan.no_return_directions, growing.scan()->no_return_directions);
    }
    EXPECT_GE(step, 5);
    EXPECT_LE(known_until, sweep.end);
    EXPECT_LT(
        (growing.scan()->T_local_sensor.translation() - sweep.scan.T_local_sensor.translation())
            .norm(),
        0.05);
    ++num_followed;
  }
  EXPECT_GE(num_followed, 5u);
}

TEST(SweepGrowthTest, ARestingTiltGrowsNothing) {
  SweepAssembler assembler{SweepParams()};
  for (int i = 0; i < 100; ++i) {
    TimedPose pose;
    pose.time = Time(i * kLinePeriod);
    assembler.AddPose(pose);
    assembler.AddLine({pose.time, 0.0, 0.1, {1.0f, 2.0f}});
    EXPECT_FALSE(assembler.TakeGrowth(0.05));
  }
}

// What the end of a sweep says of it.
SweepEnd EndOf(const Sweep& sweep) {
  SweepEnd end;
  end.begin = sweep.begin;
  end.end = sweep.end;
  end.num_steps = sweep.rest->step + (sweep.rest->num_lines > 0 ? 1 : 0);
  end.num_lines = sweep.num_lines;
  end.num_points = sweep.scan.points.size();
  end.num_no_returns = sweep.scan.no_return_directions.size();
  return end;
}

TEST(SweepGrowthTest, GrowthsAndTheRestAreTheSweep) {
  const Recorded recorded = Record(800, 0.3);
  std::size_t num_whole = 0;
  for (const Sweep& sweep : recorded.sweeps) {
    if (!sweep.complete()) continue;
    ASSERT_TRUE(sweep.rest);
    const SweepEnd end = EndOf(sweep);
    GrowingScan growing;
    for (const SweepGrowth& growth : recorded.growths) {
      if (growth.sweep_begin != sweep.begin) continue;
      ASSERT_TRUE(growing.Add(growth));
    }
    if (sweep.rest->num_lines > 0) {
      EXPECT_FALSE(growing.IsWhole(end));
      ASSERT_TRUE(growing.Add(*sweep.rest));
    }
    EXPECT_TRUE(growing.IsWhole(end));
    EXPECT_EQ(growing.scan()->points, sweep.scan.points);
    EXPECT_EQ(growing.scan()->no_return_directions, sweep.scan.no_return_directions);
    EXPECT_TRUE(PosesNear(growing.scan()->T_local_sensor, sweep.scan.T_local_sensor, 0.03, 0.02));
    ++num_whole;
  }
  EXPECT_GE(num_whole, 5u);
}

TEST(SweepGrowthTest, WhereNoGrowthWasTakenThereIsNoRest) {
  for (const Sweep& sweep : Record(800, 0.0).sweeps) EXPECT_FALSE(sweep.rest);
}

SweepGrowth Step(std::int64_t sweep, int step, int num_points) {
  SweepGrowth growth;
  growth.sweep_begin = Time(sweep);
  growth.step = step;
  growth.begin = growth.end = Time(sweep + step);
  growth.scan = RandomValues(static_cast<unsigned>(step + 1)).AScan(num_points, 1);
  return growth;
}

TEST(GrowingScanTest, AMissingStepGivesTheSweepUpAndTheNextSweepBeginsAnew) {
  GrowingScan growing;
  EXPECT_FALSE(growing.Add(Step(7, 1, 10)));  // came in the middle
  EXPECT_TRUE(growing.Add(Step(7, 0, 10)));
  EXPECT_TRUE(growing.Add(Step(7, 1, 10)));
  EXPECT_EQ(growing.scan()->points.size(), 20u);
  EXPECT_FALSE(growing.Add(Step(7, 3, 10)));
  EXPECT_FALSE(growing.scan());
  EXPECT_FALSE(growing.Add(Step(7, 4, 10)));
  EXPECT_TRUE(growing.Add(Step(8, 0, 5)));
  EXPECT_EQ(growing.scan()->points.size(), 5u);
  EXPECT_EQ(growing.sweep_begin(), Time(8));
}

TEST(GrowingScanTest, StepsOfAnotherSweepAndRepeatedOnesAreNoGrowth) {
  GrowingScan growing;
  EXPECT_TRUE(growing.Add(Step(7, 0, 10)));
  EXPECT_FALSE(growing.Add(Step(9, 1, 10)));
  EXPECT_TRUE(growing.Add(Step(7, 0, 10)));
  EXPECT_TRUE(growing.Add(Step(7, 1, 10)));
  EXPECT_FALSE(growing.Add(Step(7, 1, 10)));
}

TEST(GrowingScanTest, IsWholeOnlyWhenEverythingIsAsTheEndSays) {
  GrowingScan growing;
  growing.Add(Step(7, 0, 10));
  growing.Add(Step(7, 1, 5));
  SweepEnd end;
  end.begin = Time(7);
  end.end = Time(8);
  end.num_steps = 2;
  end.num_points = 15;
  end.num_no_returns = 2;
  EXPECT_TRUE(growing.IsWhole(end));
  const auto differs = [&](auto change) {
    SweepEnd other = end;
    change(&other);
    return !growing.IsWhole(other);
  };
  EXPECT_TRUE(differs([](SweepEnd* e) { e->begin = Time(6); }));
  EXPECT_TRUE(differs([](SweepEnd* e) { e->end = Time(9); }));
  EXPECT_TRUE(differs([](SweepEnd* e) { e->num_steps = 3; }));
  EXPECT_TRUE(differs([](SweepEnd* e) { e->num_lines = 1; }));
  EXPECT_TRUE(differs([](SweepEnd* e) { e->num_points = 14; }));
  EXPECT_TRUE(differs([](SweepEnd* e) { e->num_no_returns = 3; }));
  growing.Add(Step(7, 3, 5));
  EXPECT_FALSE(growing.IsWhole(end)) << "a step is missing";
}

// What was seen stays where it was while the sensor does about that, and no longer.
TEST(GrowingScanTest, TheSensorsPoseIsTheFirstOneThatIsAboutTheSame) {
  GrowingScan growing;
  const auto add = [&growing](int step, double x, double heading) {
    SweepGrowth growth = Step(7, step, 1);
    growth.scan.T_local_sensor = Eigen::Isometry3d::Identity();
    growth.scan.T_local_sensor.translation().x() = x;
    growth.scan.T_local_sensor.rotate(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
    growing.Add(growth);
    return growth.scan.T_local_sensor.matrix();
  };
  const Eigen::Matrix4d first = add(0, 1.0, 0.0);
  add(1, 1.02, 0.01);
  EXPECT_EQ(growing.scan()->T_local_sensor.matrix(), first);
  const Eigen::Matrix4d moved = add(2, 1.04, 0.01);
  EXPECT_EQ(growing.scan()->T_local_sensor.matrix(), moved);
  add(3, 1.02, 0.0);
  EXPECT_EQ(growing.scan()->T_local_sensor.matrix(), moved);
  const Eigen::Matrix4d turned = add(4, 1.02, 0.05);
  EXPECT_EQ(growing.scan()->T_local_sensor.matrix(), turned);
}

}  // namespace
}  // namespace rimod
