#include "rimod/sweep_assembler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>

namespace rimod {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr std::int64_t kLinePeriod = 26670;  // us
constexpr std::int64_t kStart = 1236148361904667;
constexpr float kNoReturn = 81.91f;

// A laser that moves as told: pose at a time in seconds since kStart.
using Motion = std::function<Eigen::Isometry3d(double)>;

Eigen::Isometry3d Tilted(double tilt, const Eigen::Vector3d& position = {0, 0, 1.1}) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()).toRotationMatrix();
  T.translation() = position;
  return T;
}

// Tilts steadily from first to last (rad) at 0.25 degrees a line, then rests.
Motion SteadyTilt(double first, double last) {
  return [=](double seconds) {
    const double rate = 0.25 * kDegree / (kLinePeriod * 1e-6);
    const double turned = std::min(seconds * rate, std::abs(last - first));
    return Tilted(last > first ? first + turned : first - turned);
  };
}

struct Input {
  std::vector<LaserLine> lines;
  std::vector<TimedPose> poses;
};

double SecondsSinceStart(Time time) { return static_cast<double>(time.count() - kStart) * 1e-6; }

LaserLine MakeLine(std::int64_t utime, bool shifted, float range) {
  LaserLine line;
  line.time = Time(utime);
  line.angle_step = 0.5 * kDegree;
  line.first_angle = (shifted ? -89.75 : -90.0) * kDegree;
  line.ranges.assign(shifted ? 360 : 361, range);
  return line;
}

TimedPose MakePose(std::int64_t utime, const Motion& motion) {
  return {Time(utime), motion(SecondsSinceStart(Time(utime)))};
}

// Interlaced lines of random ranges with a pose at the start of each and one more at the end.
Input Record(int num_lines, const Motion& motion, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> range(0.5f, 10.0f);
  Input input;
  for (int i = 0; i <= num_lines; ++i) {
    const std::int64_t utime = kStart + i * kLinePeriod;
    input.poses.push_back(MakePose(utime, motion));
    if (i == num_lines) break;
    input.lines.push_back(MakeLine(utime, i % 2 == 1, 1.0f));
    for (float& r : input.lines.back().ranges) r = range(random);
  }
  return input;
}

void Append(std::vector<Sweep> more, std::vector<Sweep>* all) {
  for (Sweep& sweep : more) all->push_back(std::move(sweep));
}

// Feeds both streams in the order of time, poses first, and finishes.
std::vector<Sweep> Assemble(const Input& input, SweepAssembler* assembler) {
  std::vector<Sweep> sweeps;
  std::size_t pose = 0;
  for (const LaserLine& line : input.lines) {
    while (pose < input.poses.size() && input.poses[pose].time <= line.time) {
      Append(assembler->AddPose(input.poses[pose++]), &sweeps);
    }
    Append(assembler->AddLine(line), &sweeps);
  }
  while (pose < input.poses.size()) Append(assembler->AddPose(input.poses[pose++]), &sweeps);
  Append(assembler->Finish(), &sweeps);
  return sweeps;
}

std::vector<Sweep> Assemble(const Input& input) {
  SweepAssembler assembler{SweepParams()};
  return Assemble(input, &assembler);
}

// Where the beam's point is, computed the plain way from the true motion.
Eigen::Vector3d TruePoint(const LaserLine& line, std::size_t beam, const Motion& motion) {
  const double seconds = SecondsSinceStart(line.time) + static_cast<double>(beam) / 361.0 * 0.02667;
  const double angle = line.first_angle + static_cast<double>(beam) * line.angle_step;
  return motion(seconds) * (static_cast<double>(line.ranges[beam]) *
                            Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
}

void ExpectSameSweeps(const std::vector<Sweep>& a, const std::vector<Sweep>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].begin, b[i].begin);
    EXPECT_EQ(a[i].end, b[i].end);
    EXPECT_EQ(a[i].num_lines, b[i].num_lines);
    EXPECT_EQ(a[i].num_missing_lines, b[i].num_missing_lines);
    EXPECT_EQ(a[i].incomplete_reason, b[i].incomplete_reason);
    EXPECT_EQ(a[i].scan.points, b[i].scan.points);
    EXPECT_EQ(a[i].scan.no_return_directions, b[i].scan.no_return_directions);
    EXPECT_EQ(a[i].scan.T_local_sensor.matrix(), b[i].scan.T_local_sensor.matrix());
  }
}

TEST(SweepAssemblerTest, PlacesEveryBeamByThePoseAtItsOwnTime) {
  const Motion motion = SteadyTilt(-30 * kDegree, 80 * kDegree);
  const Input input = Record(361, motion);
  const std::vector<Sweep> sweeps = Assemble(input);
  ASSERT_EQ(sweeps.size(), 1u);
  ASSERT_TRUE(sweeps[0].complete()) << sweeps[0].incomplete_reason;
  EXPECT_EQ(sweeps[0].num_lines, 361);
  EXPECT_EQ(sweeps[0].num_missing_lines, 0);
  EXPECT_EQ(sweeps[0].begin, input.lines.front().time);
  EXPECT_NEAR(sweeps[0].turned_angle, 90.25 * kDegree, 0.01 * kDegree);
  const std::vector<Eigen::Vector3f>& points = sweeps[0].scan.points;
  ASSERT_EQ(points.size(), 181u * 361u + 180u * 360u);
  std::size_t next = 0;
  for (const LaserLine& line : input.lines) {
    for (std::size_t beam = 0; beam < line.ranges.size(); ++beam) {
      const Eigen::Vector3d expected = TruePoint(line, beam, motion);
      ASSERT_LT((points[next++].cast<double>() - expected).norm(), 2e-6);
    }
  }
}

TEST(SweepAssemblerTest, FollowsACarrierThatDrivesAndPosesAtTheirOwnRate) {
  // Straight drive with a constant turn of the tilt: between any two poses the motion is what lerp
  // and slerp give, so poses at odd times must not matter.
  const Motion motion = [](double seconds) {
    return Tilted(-0.4 + 0.15 * seconds, {0.3 * seconds, -0.1 * seconds, 1.0});
  };
  Input input = Record(300, motion);
  input.poses.clear();
  for (std::int64_t t = -5000; t < 301 * kLinePeriod; t += 7013) {
    input.poses.push_back(MakePose(kStart + t, motion));
  }
  const std::vector<Sweep> sweeps = Assemble(input);
  ASSERT_EQ(sweeps.size(), 1u);
  ASSERT_TRUE(sweeps[0].complete());
  ASSERT_EQ(sweeps[0].num_lines, 300);
  std::size_t next = 0;
  for (const LaserLine& line : input.lines) {
    for (std::size_t beam = 0; beam < line.ranges.size(); ++beam) {
      const Eigen::Vector3d expected = TruePoint(line, beam, motion);
      ASSERT_LT((sweeps[0].scan.points[next++].cast<double>() - expected).norm(), 3e-6);
    }
  }
}

TEST(SweepAssemblerTest, SensorPoseIsLevelWithMeanPositionAndHeading) {
  const double heading = 35 * kDegree;
  const Motion turned = [=](double seconds) {
    Eigen::Isometry3d T = Eigen::Isometry3d(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ())) *
                          SteadyTilt(-30 * kDegree, 80 * kDegree)(seconds);
    T.translation() = Eigen::Vector3d(1.0 + 0.1 * seconds, 2.0, 1.5);
    return T;
  };
  const std::vector<Sweep> sweeps = Assemble(Record(361, turned));
  ASSERT_EQ(sweeps.size(), 1u);
  const Eigen::Isometry3d& T = sweeps[0].scan.T_local_sensor;
  EXPECT_NEAR(T.translation().x(), 1.0 + 0.1 * 180 * 0.02667, 1e-9);
  EXPECT_NEAR(T.translation().y(), 2.0, 1e-12);
  EXPECT_NEAR(T.translation().z(), 1.5, 1e-12);
  const Eigen::Vector3d forward = T.linear().col(0);
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), heading, 1e-9);
  EXPECT_EQ(Eigen::Vector3d(T.linear().col(2)), Eigen::Vector3d::UnitZ());
}

TEST(SweepAssemblerTest, SensorAtRestKeepsItsPoseExactly) {
  const std::vector<Sweep> sweeps = Assemble(Record(361, SteadyTilt(-0.5, 1.5)));
  ASSERT_EQ(sweeps.size(), 1u);
  Eigen::Isometry3d expected = Eigen::Isometry3d::Identity();
  expected.translation() = Eigen::Vector3d(0, 0, 1.1);
  EXPECT_EQ(sweeps[0].scan.T_local_sensor.matrix(), expected.matrix());
}

TEST(SweepAssemblerTest, ResultDoesNotDependOnHowTheStreamsInterleave) {
  Input input = Record(361, SteadyTilt(-30 * kDegree, 80 * kDegree));
  input.lines.erase(input.lines.begin() + 100, input.lines.begin() + 104);
  input.poses.erase(input.poses.begin() + 200, input.poses.begin() + 210);
  const std::vector<Sweep> expected = Assemble(input);
  ASSERT_EQ(expected.size(), 1u);
  ASSERT_TRUE(expected[0].complete()) << expected[0].incomplete_reason;
  std::mt19937 random(3);
  for (const double pose_chance : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    std::bernoulli_distribution pose_next(pose_chance);
    SweepAssembler assembler{SweepParams()};
    std::vector<Sweep> sweeps;
    std::size_t line = 0, pose = 0;
    while (line < input.lines.size() || pose < input.poses.size()) {
      const bool take_pose =
          line == input.lines.size() || (pose < input.poses.size() && pose_next(random));
      Append(take_pose ? assembler.AddPose(input.poses[pose++])
                       : assembler.AddLine(input.lines[line++]),
             &sweeps);
    }
    Append(assembler.Finish(), &sweeps);
    ExpectSameSweeps(expected, sweeps);
  }
}

TEST(SweepAssemblerTest, ReversalOfTheTiltEndsASweepAndBeginsTheNextThere) {
  // Nods between -30 and 60.25 degrees three times without a pause.
  const Motion nodding = [](double seconds) {
    const double turned = seconds * 0.25 / (kLinePeriod * 1e-6);
    const double phase = std::fmod(turned, 2 * 90.25);
    return Tilted((phase < 90.25 ? -30.0 + phase : 60.25 - (phase - 90.25)) * kDegree);
  };
  const Input input = Record(3 * 361, nodding);
  SweepAssembler assembler{SweepParams()};
  const std::vector<Sweep> sweeps = Assemble(input, &assembler);
  ASSERT_EQ(sweeps.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(sweeps[i].complete()) << sweeps[i].incomplete_reason;
    EXPECT_EQ(sweeps[i].num_lines, 361);
    EXPECT_EQ(sweeps[i].begin, input.lines[i * 361].time);
    EXPECT_EQ(sweeps[i].turned_angle > 0.0, i != 1);
  }
  EXPECT_EQ(assembler.counters().idle_lines, 0);
  EXPECT_EQ(assembler.counters().complete_sweeps, 3);
  EXPECT_FALSE(assembler.collecting());
}

TEST(SweepAssemblerTest, RestOfTheTiltEndsASweepWithoutWaitingForMore) {
  // 200 lines of rest, 361 of motion, 300 of rest: the sweep must be out before the end.
  const Motion motion = [](double seconds) {
    const double start = 200 * kLinePeriod * 1e-6;
    return SteadyTilt(-30 * kDegree, 60.25 * kDegree)(std::max(0.0, seconds - start));
  };
  const Input input = Record(861, motion);
  SweepAssembler assembler{SweepParams()};
  std::vector<Sweep> sweeps;
  std::size_t ended_at = 0;
  for (std::size_t i = 0; i < input.lines.size(); ++i) {
    Append(assembler.AddPose(input.poses[i]), &sweeps);
    Append(assembler.AddLine(input.lines[i]), &sweeps);
    if (!sweeps.empty() && ended_at == 0) ended_at = i;
  }
  Append(assembler.Finish(), &sweeps);
  ASSERT_EQ(sweeps.size(), 1u);
  EXPECT_TRUE(sweeps[0].complete());
  EXPECT_EQ(sweeps[0].num_lines, 361);
  EXPECT_EQ(sweeps[0].begin, input.lines[200].time);
  EXPECT_LE(ended_at, 200u + 361u + 25u);
  // The last line waits for the pose after it, which was never given.
  EXPECT_EQ(assembler.counters().idle_lines, 499);
  EXPECT_EQ(assembler.counters().lines_without_pose, 1);
}

// Down and up between the same tilts, again and again.
TEST(SweepAssemblerTest, FromTheFourthSweepOfADirectionOnTheLastLineReachesAKnownEnd) {
  constexpr int kLinesASweep = 100;
  const auto nodding = [](double seconds) {
    const double lines = seconds / (kLinePeriod * 1e-6);
    const double phase = std::fmod(lines, 2.0 * kLinesASweep);
    return Tilted(0.25 * kDegree * std::min(phase, 2.0 * kLinesASweep - phase));
  };
  const Input input = Record(10 * kLinesASweep, nodding);
  SweepAssembler assembler{SweepParams()};
  std::vector<std::size_t> reached;
  for (std::size_t i = 0; i < input.poses.size(); ++i) {
    assembler.AddPose(input.poses[i]);
    if (assembler.reached_known_end()) reached.push_back(i);
    if (i == input.lines.size()) break;
    assembler.AddLine(input.lines[i]);
  }
  // The pose with which a sweep's last line is placed.
  EXPECT_EQ(reached, (std::vector<std::size_t>{700, 800, 900, 1000}));
}

TEST(SweepAssemblerTest, PauseInTheLinesEndsASweep) {
  Input input = Record(800, SteadyTilt(-60 * kDegree, 160 * kDegree));
  input.lines.erase(input.lines.begin() + 400, input.lines.begin() + 420);  // 0.56 s
  const std::vector<Sweep> sweeps = Assemble(input);
  ASSERT_EQ(sweeps.size(), 2u);
  EXPECT_TRUE(sweeps[0].complete());
  EXPECT_TRUE(sweeps[1].complete());
  EXPECT_EQ(sweeps[0].num_lines, 400);
  EXPECT_EQ(sweeps[1].num_lines, 380);
}

// Lines of a second laser between those of the first, at any distance from them.
TEST(SweepAssemblerTest, LinesOfTwoLasersMakeNoScanAndAreCounted) {
  for (const std::int64_t distance : {1, 5000, 13335, 26669}) {
    Input input = Record(100, SteadyTilt(-0.3, 0.3));
    Input second = input;
    input.lines.clear();
    for (const LaserLine& line : second.lines) {
      input.lines.push_back(line);
      input.lines.push_back(line);
      input.lines.back().time += Time(distance);
    }
    SweepAssembler assembler{SweepParams()};
    const std::vector<Sweep> sweeps = Assemble(input, &assembler);
    ASSERT_FALSE(sweeps.empty()) << distance;
    for (const Sweep& sweep : sweeps) {
      EXPECT_NE(sweep.incomplete_reason.find("two on one channel"), std::string::npos)
          << distance << ": " << sweep.incomplete_reason;
      EXPECT_TRUE(sweep.scan.points.empty());
    }
    EXPECT_GE(assembler.counters().crowded_lines, 90) << distance;
  }
}

TEST(SweepAssemblerTest, AFewLinesThatCrowdCostNothing) {
  Input input = Record(100, SteadyTilt(-0.3, 0.3));
  for (std::size_t i = 10; i < 100; i += 10) input.lines[i].time += Time(12000);  // stamped late
  SweepAssembler assembler{SweepParams()};
  const std::vector<Sweep> sweeps = Assemble(input, &assembler);
  ASSERT_EQ(sweeps.size(), 1u);
  EXPECT_TRUE(sweeps[0].complete()) << sweeps[0].incomplete_reason;
  EXPECT_EQ(assembler.counters().crowded_lines, 9);
}

TEST(SweepAssemblerTest, TiltMayPassTheVertical) {
  const std::vector<Sweep> sweeps = Assemble(Record(1000, SteadyTilt(-100 * kDegree, 4.0)));
  ASSERT_EQ(sweeps.size(), 1u);
  EXPECT_EQ(sweeps[0].num_lines, 1000);
}

TEST(SweepAssemblerTest, HeadingAndRollOfTheCarrierAreNoTilt) {
  const Motion motion = [](double seconds) {
    Eigen::Isometry3d T_local_carrier = Eigen::Isometry3d::Identity();
    T_local_carrier.rotate(Eigen::AngleAxisd(0.8 * seconds, Eigen::Vector3d::UnitZ()));
    T_local_carrier.rotate(
        Eigen::AngleAxisd(0.2 * std::sin(3.0 * seconds), Eigen::Vector3d::UnitX()));
    return T_local_carrier * Tilted(0.3);
  };
  SweepAssembler assembler{SweepParams()};
  EXPECT_TRUE(Assemble(Record(400, motion), &assembler).empty());
  EXPECT_EQ(assembler.counters().idle_lines, 400);
}

TEST(SweepAssemblerTest, SmallTurnIsReportedAsIncomplete) {
  const std::vector<Sweep> sweeps = Assemble(Record(60, SteadyTilt(0.0, 1.0)));
  ASSERT_EQ(sweeps.size(), 1u);
  EXPECT_FALSE(sweeps[0].complete());
  EXPECT_EQ(sweeps[0].incomplete_reason, "turned only 15.0 degrees of at least 20.1");
  EXPECT_TRUE(sweeps[0].scan.points.empty());
}

TEST(SweepAssemblerTest, MissingLinesAreCountedAndTooManyMakeTheSweepIncomplete) {
  const Input whole = Record(361, SteadyTilt(-0.5, 2.0));
  Input some = whole;
  for (int k = 0; k < 18; ++k) some.lines.erase(some.lines.begin() + 10 + 15 * k);
  SweepAssembler assembler{SweepParams()};
  const std::vector<Sweep> tolerated = Assemble(some, &assembler);
  ASSERT_EQ(tolerated.size(), 1u);
  EXPECT_TRUE(tolerated[0].complete()) << tolerated[0].incomplete_reason;
  EXPECT_EQ(tolerated[0].num_missing_lines, 18);
  EXPECT_EQ(assembler.counters().missing_lines, 18);
  Input many = whole;
  for (int k = 0; k < 19; ++k) many.lines.erase(many.lines.begin() + 10 + 15 * k);
  const std::vector<Sweep> refused = Assemble(many);
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_EQ(refused[0].incomplete_reason, "19 of 361 lines are missing");
}

TEST(SweepAssemblerTest, TooLongSweepIsEndedAsIncomplete) {
  SweepParams params;
  params.max_lines = 100;
  SweepAssembler assembler(params);
  const std::vector<Sweep> sweeps = Assemble(Record(250, SteadyTilt(-0.5, 2.0)), &assembler);
  ASSERT_EQ(sweeps.size(), 3u);
  EXPECT_EQ(sweeps[0].incomplete_reason, "longer than 100 lines");
  EXPECT_EQ(sweeps[0].num_lines, 101);
  EXPECT_EQ(sweeps[2].incomplete_reason, "turned only 12.0 degrees of at least 20.1");
  EXPECT_EQ(assembler.counters().incomplete_sweeps, 3);
}

TEST(SweepAssemblerTest, RangesAreSortedByKind) {
  Input input = Record(361, SteadyTilt(-0.5, 2.0));
  std::vector<float>& ranges = input.lines[5].ranges;
  ranges[0] = kNoReturn;
  ranges[1] = std::numeric_limits<float>::infinity();
  ranges[2] = 81.9f;  // the first that is no return
  ranges[3] = 0.29f;
  ranges[4] = 0.0f;
  ranges[5] = std::numeric_limits<float>::quiet_NaN();
  ranges[6] = -1.0f;
  ranges[7] = -std::numeric_limits<float>::infinity();
  ranges[8] = 0.3f;  // the first that counts
  ranges[9] = 81.89f;
  SweepAssembler assembler{SweepParams()};
  const std::vector<Sweep> sweeps = Assemble(input, &assembler);
  ASSERT_EQ(sweeps.size(), 1u);
  EXPECT_EQ(sweeps[0].scan.points.size(), 181u * 361u + 180u * 360u - 8u);
  ASSERT_EQ(sweeps[0].scan.no_return_directions.size(), 3u);
  for (const Eigen::Vector3f& direction : sweeps[0].scan.no_return_directions) {
    EXPECT_NEAR(direction.norm(), 1.0f, 1e-6f);
  }
  for (const Eigen::Vector3f& point : sweeps[0].scan.points) ASSERT_TRUE(point.allFinite());
  EXPECT_EQ(assembler.counters().near_ranges, 2);
  EXPECT_EQ(assembler.counters().bad_ranges, 3);
}

TEST(SweepAssemblerTest, NoReturnDirectionsPointAlongTheirBeams) {
  const Motion motion = SteadyTilt(-0.5, 2.0);
  Input input = Record(361, motion);
  input.lines[37].ranges[100] = kNoReturn;
  const std::vector<Sweep> sweeps = Assemble(input);
  ASSERT_EQ(sweeps[0].scan.no_return_directions.size(), 1u);
  input.lines[37].ranges[100] = 1.0f;
  const Eigen::Vector3d expected =
      TruePoint(input.lines[37], 100, motion) - Eigen::Vector3d(0, 0, 1.1);
  EXPECT_LT((sweeps[0].scan.no_return_directions[0].cast<double>() - expected).norm(), 1e-6);
}

TEST(SweepAssemblerTest, RepeatedAndLateInputIsLeftOut) {
  const Input input = Record(361, SteadyTilt(-0.5, 2.0));
  Input doubled;
  for (std::size_t i = 0; i < input.lines.size(); ++i) {
    doubled.lines.push_back(input.lines[i]);
    if (i % 3 == 0) doubled.lines.push_back(input.lines[i]);
    if (i >= 3 && i % 5 == 0) doubled.lines.push_back(input.lines[i - 3]);
  }
  SweepAssembler assembler{SweepParams()};
  std::vector<Sweep> sweeps;
  for (const TimedPose& pose : input.poses) {
    Append(assembler.AddPose(pose), &sweeps);
    Append(assembler.AddPose(pose), &sweeps);
  }
  for (const LaserLine& line : doubled.lines) Append(assembler.AddLine(line), &sweeps);
  Append(assembler.Finish(), &sweeps);
  ExpectSameSweeps(Assemble(input), sweeps);
  EXPECT_EQ(assembler.counters().unordered_lines,
            static_cast<std::int64_t>(doubled.lines.size() - input.lines.size()));
  EXPECT_EQ(assembler.counters().unordered_poses, 362);
  EXPECT_EQ(assembler.counters().lines, 361);
}

TEST(SweepAssemblerTest, UnusableLinesAreCountedAndChangeNothing) {
  const Input input = Record(361, SteadyTilt(-0.5, 2.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<LaserLine> bad(8, input.lines[50]);
  bad[0].ranges.clear();
  bad[1].first_angle = nan;
  bad[2].angle_step = std::numeric_limits<double>::infinity();
  bad[3].angle_step = 0.0;
  bad[4].ranges.resize(721 + 10, 1.0f);  // over a turn at half a degree
  bad[5].ranges.resize(20000, 1.0f);
  bad[5].angle_step = 1e-5;
  bad[6].time = Time::min();
  bad[7].time = Time::max();
  SweepAssembler assembler{SweepParams()};
  std::vector<Sweep> sweeps;
  for (std::size_t i = 0; i < input.lines.size(); ++i) {
    Append(assembler.AddPose(input.poses[i]), &sweeps);
    Append(assembler.AddLine(bad[i % bad.size()]), &sweeps);
    Append(assembler.AddLine(input.lines[i]), &sweeps);
  }
  Append(assembler.AddPose(input.poses.back()), &sweeps);
  Append(assembler.Finish(), &sweeps);
  ExpectSameSweeps(Assemble(input), sweeps);
  EXPECT_EQ(assembler.counters().bad_lines, 361);
}

TEST(SweepAssemblerTest, UnusablePosesAreCountedAndChangeNothing) {
  const Input input = Record(361, SteadyTilt(-0.5, 2.0));
  std::vector<TimedPose> bad(6, input.poses[50]);
  bad[0].T_local_laser.translation().x() = std::numeric_limits<double>::quiet_NaN();
  bad[1].T_local_laser.linear().setZero();
  bad[2].T_local_laser.linear() *= 1.1;
  bad[3].T_local_laser.linear()(0, 0) *= -1.0;
  bad[4].T_local_laser.translation().y() = 1e300;
  bad[5].time = Time::max();
  SweepAssembler assembler{SweepParams()};
  std::vector<Sweep> sweeps;
  for (std::size_t i = 0; i < input.poses.size(); ++i) {
    Append(assembler.AddPose(bad[i % bad.size()]), &sweeps);
    Append(assembler.AddPose(input.poses[i]), &sweeps);
    if (i < input.lines.size()) Append(assembler.AddLine(input.lines[i]), &sweeps);
  }
  Append(assembler.Finish(), &sweeps);
  ExpectSameSweeps(Assemble(input), sweeps);
  EXPECT_EQ(assembler.counters().bad_poses, 362);
}

TEST(SweepAssemblerTest, LinesWithoutPosesNearbyAreLeftOutAndCountAsMissing) {
  Input input = Record(361, SteadyTilt(-0.5, 2.0));
  input.poses.erase(input.poses.begin() + 100, input.poses.begin() + 109);  // a gap of 0.27 s
  SweepAssembler assembler{SweepParams()};
  const std::vector<Sweep> sweeps = Assemble(input, &assembler);
  ASSERT_EQ(sweeps.size(), 1u);
  EXPECT_TRUE(sweeps[0].complete());
  EXPECT_EQ(sweeps[0].num_lines, 351);
  EXPECT_EQ(sweeps[0].num_missing_lines, 10);
  EXPECT_EQ(assembler.counters().lines_without_pose, 10);
}

TEST(SweepAssemblerTest, LinesBeforeTheFirstAndAfterTheLastPoseAreLeftOut) {
  Input input = Record(361, SteadyTilt(-0.5, 2.0));
  input.poses.erase(input.poses.begin(), input.poses.begin() + 3);
  input.poses.resize(input.poses.size() - 2);
  SweepAssembler assembler{SweepParams()};
  const std::vector<Sweep> sweeps = Assemble(input, &assembler);
  ASSERT_EQ(sweeps.size(), 1u);
  EXPECT_EQ(sweeps[0].num_lines, 361 - 3 - 2);
  EXPECT_EQ(sweeps[0].begin, input.lines[3].time);
  EXPECT_EQ(assembler.counters().lines_without_pose, 5);
}

TEST(SweepAssemblerTest, ReplayFromTheStartEndsTheSweepAndGoesOn) {
  const Input input = Record(361, SteadyTilt(-0.5, 2.0));
  SweepAssembler assembler{SweepParams()};
  std::vector<Sweep> sweeps;
  const auto play = [&](std::size_t num_lines) {
    for (std::size_t i = 0; i < num_lines; ++i) {
      Append(assembler.AddPose(input.poses[i]), &sweeps);
      Append(assembler.AddLine(input.lines[i]), &sweeps);
    }
  };
  play(200);
  play(361);
  Append(assembler.AddPose(input.poses.back()), &sweeps);
  Append(assembler.Finish(), &sweeps);
  ASSERT_EQ(sweeps.size(), 2u);
  EXPECT_EQ(sweeps[0].incomplete_reason, "the clock ran backwards");
  EXPECT_EQ(sweeps[0].num_lines, 199);  // the 200th waited for its pose
  EXPECT_TRUE(sweeps[1].complete());
  EXPECT_EQ(sweeps[1].num_lines, 361);
  EXPECT_EQ(assembler.counters().clock_jumps, 1);
}

TEST(SweepAssemblerTest, ReplayWorksWhicheverStreamJumpsFirst) {
  const Input input = Record(361, SteadyTilt(-0.5, 2.0));
  for (const int pose_lead : {-7, -1, 1, 7}) {
    SweepAssembler assembler{SweepParams()};
    std::vector<Sweep> sweeps;
    const int total = 2 * 361;
    for (int i = -10; i < total + 10; ++i) {
      const int pose = i + pose_lead;
      if (pose >= 0 && pose < total) Append(assembler.AddPose(input.poses[pose % 361]), &sweeps);
      if (i >= 0 && i < total) Append(assembler.AddLine(input.lines[i % 361]), &sweeps);
    }
    Append(assembler.AddPose(input.poses.back()), &sweeps);
    Append(assembler.Finish(), &sweeps);
    ASSERT_EQ(sweeps.size(), 2u) << "lead " << pose_lead;
    EXPECT_EQ(sweeps[0].incomplete_reason, "the clock ran backwards");
    EXPECT_TRUE(sweeps[1].complete()) << sweeps[1].incomplete_reason;
    EXPECT_GE(sweeps[1].num_lines, 361 - 7) << "lead " << pose_lead;
  }
}

TEST(SweepAssemblerTest, OneTimeFarAheadCostsNoSweep) {
  const Input input = Record(361, SteadyTilt(-0.5, 2.0));
  SweepAssembler assembler{SweepParams()};
  std::vector<Sweep> sweeps;
  for (std::size_t i = 0; i < input.lines.size(); ++i) {
    Append(assembler.AddPose(input.poses[i]), &sweeps);
    if (i == 100) {
      LaserLine ahead = input.lines[i];
      ahead.time += std::chrono::hours(1000);
      Append(assembler.AddLine(ahead), &sweeps);
    }
    if (i == 200) {
      TimedPose ahead = input.poses[i];
      ahead.time += std::chrono::hours(1000);
      Append(assembler.AddPose(ahead), &sweeps);
    }
    Append(assembler.AddLine(input.lines[i]), &sweeps);
  }
  Append(assembler.AddPose(input.poses.back()), &sweeps);
  Append(assembler.Finish(), &sweeps);
  ASSERT_EQ(sweeps.size(), 1u);
  EXPECT_TRUE(sweeps[0].complete()) << sweeps[0].incomplete_reason;
  EXPECT_GE(sweeps[0].num_lines, 359);
  EXPECT_EQ(assembler.counters().clock_jumps, 2);
}

TEST(SweepAssemblerTest, SilentStreamsFillNoMemory) {
  SweepParams params;
  params.max_buffered_lines = 50;
  params.max_buffered_poses = 70;
  const Input input = Record(361, SteadyTilt(-0.5, 2.0));
  SweepAssembler lines_only(params);
  for (const LaserLine& line : input.lines) EXPECT_TRUE(lines_only.AddLine(line).empty());
  EXPECT_TRUE(lines_only.collecting());
  EXPECT_TRUE(lines_only.Finish().empty());
  EXPECT_FALSE(lines_only.collecting());
  EXPECT_EQ(lines_only.counters().lines_without_pose, 361);
  SweepAssembler poses_only(params);
  for (const TimedPose& pose : input.poses) EXPECT_TRUE(poses_only.AddPose(pose).empty());
  EXPECT_EQ(poses_only.counters().poses, 362);
  EXPECT_FALSE(poses_only.collecting());
  // Of the poses the newest 70 are left: lines before them find none.
  for (const LaserLine& line : input.lines) poses_only.AddLine(line);
  EXPECT_EQ(poses_only.counters().lines, 69);
}

TEST(SweepAssemblerTest, NothingGivesNothing) {
  SweepAssembler assembler{SweepParams()};
  EXPECT_FALSE(assembler.collecting());
  EXPECT_TRUE(assembler.Finish().empty());
}

TEST(SweepAssemblerTest, FinishMakesReadyForAnEarlierTime) {
  const Input input = Record(361, SteadyTilt(-0.5, 2.0));
  SweepAssembler assembler{SweepParams()};
  const std::vector<Sweep> first = Assemble(input, &assembler);
  const std::vector<Sweep> second = Assemble(input, &assembler);
  ExpectSameSweeps(first, second);
  EXPECT_EQ(assembler.counters().clock_jumps, 0);
  EXPECT_EQ(assembler.counters().complete_sweeps, 2);
}

TEST(SweepAssemblerTest, RandomInputNeverBreaksIt) {
  std::mt19937_64 random(11);
  const Input input = Record(100, SteadyTilt(-0.5, 2.0));
  SweepAssembler assembler{SweepParams()};
  const auto bits = [&] {
    const std::uint64_t word = random();
    double value;
    static_assert(sizeof(value) == sizeof(word));
    std::memcpy(&value, &word, sizeof(value));
    return value;
  };
  for (int i = 0; i < 20000; ++i) {
    LaserLine line = input.lines[random() % 100];
    TimedPose pose = input.poses[random() % 100];
    if (random() % 4 == 0) line.time = Time(static_cast<std::int64_t>(random()));
    if (random() % 4 == 0) line.first_angle = bits();
    if (random() % 4 == 0) line.angle_step = bits();
    if (random() % 4 == 0) line.ranges.resize(random() % 1000, static_cast<float>(random() % 100));
    if (random() % 4 == 0) pose.time = Time(static_cast<std::int64_t>(random()));
    if (random() % 4 == 0) pose.T_local_laser(random() % 3, random() % 4) = bits();
    for (const Sweep& sweep : assembler.AddPose(pose)) EXPECT_GT(sweep.num_lines, 0);
    for (const Sweep& sweep : assembler.AddLine(line)) EXPECT_GT(sweep.num_lines, 0);
  }
  assembler.Finish();
  const SweepCounters counters = assembler.counters();
  EXPECT_EQ(
      counters.lines + counters.bad_lines + counters.unordered_lines + counters.lines_without_pose,
      20000);
}

TEST(SweepParamsTest, DefaultsAreLegal) { EXPECT_NO_THROW(SweepParams().Validate()); }

TEST(SweepParamsTest, IllegalValuesAreNamed) {
  const auto message = [](const std::function<void(SweepParams*)>& change) -> std::string {
    SweepParams params;
    change(&params);
    try {
      SweepAssembler assembler(params);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message([](SweepParams* p) { p->line_duration = -1.0; }),
            "sweep parameter line_duration is -1, must be > 0 s");
  EXPECT_NE(message([](SweepParams* p) { p->beams_per_line = 0; }).find("beams_per_line"),
            std::string::npos);
  EXPECT_NE(message([](SweepParams* p) { p->max_range = 0.1; }).find("max_range"),
            std::string::npos);
  EXPECT_NE(message([](SweepParams* p) { p->max_pose_gap = std::nan(""); }).find("max_pose_gap"),
            std::string::npos);
  EXPECT_NE(message([](SweepParams* p) { p->max_missing_share = 1.5; }).find("max_missing_share"),
            std::string::npos);
}

}  // namespace
}  // namespace rimod
