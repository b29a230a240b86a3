#include "scanner_proc/laser_scanner.h"

#include <gtest/gtest.h>

#include <cmath>

#include "rimod/line_placer.h"

namespace rimod::simulation {
namespace {

constexpr double kDegree = M_PI / 180.0;

SceneObject MakeObject(Shape shape, const Eigen::Vector3d& position, double reflectivity = 0.6) {
  Part part;
  part.shape = std::move(shape);
  part.reflectivity = reflectivity;
  SceneObject object;
  object.T_scene_object.translation() = position;
  object.parts.push_back(std::move(part));
  return object;
}

// A wall across the view, its face at x = 3.
SceneObject Wall() { return MakeObject(BoxShape{{0.2, 40, 40}}, {3.1, 0, -20}); }

TEST(LaserScannerTest, RangesToAWallFollowTheFormula) {
  const RayCaster caster({Wall()});
  const LaserScanner scanner(Sensor(), Noise(), caster, 1, 0);
  ASSERT_EQ(scanner.num_lines(), 361);
  for (const int line : {0, 7, 120, 255, 360}) {
    const ScannedLine scanned = scanner.Scan(line);
    ASSERT_EQ(scanned.line.ranges.size(), line % 2 == 0 ? 361u : 360u);
    for (std::size_t i = 0; i < scanned.line.ranges.size(); ++i) {
      const double share = static_cast<double>(i) / 361.0;
      const double tilt = (-30.0 + 0.25 * (line + share)) * kDegree;
      const double angle =
          scanned.line.first_angle + static_cast<double>(i) * scanned.line.angle_step;
      const double forward = std::cos(angle) * std::cos(tilt);
      const double expected = 3.0 / forward;
      if (forward > 0.0 && expected < 20.0) {
        EXPECT_NEAR(scanned.line.ranges[i], expected, 2e-6) << "line " << line << " beam " << i;
        EXPECT_EQ(scanned.beams[i].object_measured, 0);
      } else if (forward < 0.0 || expected > 80.0) {
        EXPECT_EQ(scanned.line.ranges[i], 81.91f);
        EXPECT_EQ(scanned.beams[i].object_measured, kNoObject);
      }
    }
  }
}

TEST(LaserScannerTest, LinesAreInterlacedAndStampedAsTheRealOnesAre) {
  const RayCaster caster({Wall()});
  const std::int64_t start = 1236148361904667;
  const LaserScanner scanner(Sensor(), Noise(), caster, 1, start);
  const LaserLine even = scanner.Scan(0).line;
  const LaserLine odd = scanner.Scan(1).line;
  EXPECT_EQ(even.time.count(), start);
  EXPECT_EQ(odd.time.count(), start + 26670);
  EXPECT_EQ(scanner.LineTime(361).count(), start + 361 * 26670);
  EXPECT_EQ(even.first_angle, static_cast<double>(static_cast<float>(-M_PI / 2)));
  EXPECT_NEAR(odd.first_angle - even.first_angle, 0.25 * kDegree, 1e-6);
  EXPECT_NEAR(TiltOf(scanner.TimedPoseOf(0).T_local_laser), -30.0 * kDegree, 1e-12);
  EXPECT_NEAR(TiltOf(scanner.TimedPoseOf(360).T_local_laser), 60.0 * kDegree, 1e-12);
}

TEST(LaserScannerTest, TiltNodsAndRestsBetweenSweeps) {
  const RayCaster caster({});
  Sensor sensor;
  sensor.pause = 10 * sensor.line_period;
  const LaserScanner scanner(sensor, Noise(), caster, 1, 0);
  ASSERT_EQ(scanner.LinesPerSweep(), 371);
  const auto tilt = [&](std::int64_t line) {
    return TiltOf(scanner.TimedPoseOf(line).T_local_laser) / kDegree;
  };
  EXPECT_NEAR(tilt(361), 60.25, 1e-9);
  EXPECT_NEAR(tilt(366), 60.25, 1e-9);
  EXPECT_NEAR(tilt(371), 60.25, 1e-9);
  EXPECT_NEAR(tilt(372), 60.0, 1e-9);
  EXPECT_NEAR(tilt(371 + 361), -30.0, 1e-9);
  EXPECT_NEAR(tilt(2 * 371), -30.0, 1e-9);
  EXPECT_NEAR(tilt(2 * 371 + 1), -29.75, 1e-9);
}

TEST(LaserScannerTest, ACarrierThatTurnsDrivesAnArc) {
  const RayCaster caster({});
  Sensor sensor;
  sensor.position = {1, 2, 1};
  sensor.speed = 0.5;
  sensor.turn_rate = 0.25;
  const LaserScanner scanner(sensor, Noise(), caster, 1, 0);
  const double seconds = 300 * sensor.line_period;
  const Eigen::Vector3d position = scanner.PoseAt(300).translation();
  const double radius = 0.5 / 0.25;
  EXPECT_NEAR(position.x(), 1 + radius * std::sin(0.25 * seconds), 1e-9);
  EXPECT_NEAR(position.y(), 2 + radius * (1 - std::cos(0.25 * seconds)), 1e-9);
  const Eigen::Vector3d left = scanner.PoseAt(300).linear().col(1);
  EXPECT_NEAR(std::atan2(-left.x(), left.y()), 0.25 * seconds, 1e-9);
}

TEST(LaserScannerTest, NoiseHasItsDeviationAndIsTheSameEveryTime) {
  const RayCaster caster({Wall()});
  Noise noise;
  noise.range_sigma = 0.02;
  const LaserScanner exact(Sensor(), Noise(), caster, 1, 0);
  const LaserScanner noisy(Sensor(), noise, caster, 1, 0);
  const LaserScanner other_seed(Sensor(), noise, caster, 2, 0);
  double sum = 0.0, sum_sq = 0.0;
  int number = 0, num_equal = 0;
  for (int line = 100; line < 140; ++line) {
    const LaserLine truth = exact.Scan(line).line;
    const LaserLine first = noisy.Scan(line).line;
    const LaserLine again = noisy.Scan(line).line;
    const LaserLine other = other_seed.Scan(line).line;
    EXPECT_EQ(first.ranges, again.ranges);
    for (std::size_t i = 60; i < 300; ++i) {
      const double error = static_cast<double>(first.ranges[i]) - truth.ranges[i];
      sum += error;
      sum_sq += error * error;
      ++number;
      num_equal += first.ranges[i] == other.ranges[i] ? 1 : 0;
    }
  }
  EXPECT_NEAR(sum / number, 0.0, 1e-3);
  EXPECT_NEAR(std::sqrt(sum_sq / number), 0.02, 1e-3);
  EXPECT_LT(num_equal, number / 50);
}

TEST(LaserScannerTest, ReadingsAreWholeSteps) {
  const RayCaster caster({Wall()});
  Noise noise;
  noise.range_step = 0.01;
  const LaserScanner exact(Sensor(), Noise(), caster, 1, 0);
  const LaserScanner stepped(Sensor(), noise, caster, 1, 0);
  const LaserLine truth = exact.Scan(120).line;
  const LaserLine line = stepped.Scan(120).line;
  for (std::size_t i = 60; i < 300; ++i) {
    EXPECT_NEAR(line.ranges[i], truth.ranges[i], 0.00501);
    EXPECT_NEAR(std::remainder(line.ranges[i], 0.01), 0.0, 1e-5);
  }
}

TEST(LaserScannerTest, DropOutsLoseTheirShareOfReadings) {
  const RayCaster caster({Wall()});
  Noise noise;
  noise.drop_out = 0.1;
  const LaserScanner scanner(Sensor(), noise, caster, 1, 0);
  int lost = 0, number = 0;
  for (int line = 100; line < 140; ++line) {
    const ScannedLine scanned = scanner.Scan(line);
    for (std::size_t i = 60; i < 300; ++i) {
      ++number;
      lost += scanned.line.ranges[i] == 81.91f ? 1 : 0;
      EXPECT_EQ(scanned.beams[i].object_hit, 0);
    }
  }
  EXPECT_NEAR(lost / static_cast<double>(number), 0.1, 0.02);
}

TEST(LaserScannerTest, DarkSurfacesGiveFewerReadingsThanBrightOnes) {
  Noise noise;
  noise.dark_signal = 0.05;
  int previous = 1000000;
  for (const double reflectivity : {0.9, 0.1, 0.03, 0.0}) {
    const RayCaster caster({MakeObject(BoxShape{{0.2, 40, 40}}, {3.1, 0, -20}, reflectivity)});
    const LaserScanner scanner(Sensor(), noise, caster, 1, 0);
    int seen = 0;
    for (int line = 100; line < 120; ++line) {
      for (const Beam& beam : scanner.Scan(line).beams) seen += beam.object_measured == 0 ? 1 : 0;
    }
    EXPECT_LT(seen, previous);
    previous = seen;
  }
  EXPECT_EQ(previous, 0);
}

TEST(LaserScannerTest, EdgesMixReadingsOfSurfacesThatAreClose) {
  // The edge of a board at x = 2 before a wall at x = 2.3, seen by the beam along x.
  const RayCaster caster({MakeObject(BoxShape{{0.01, 10, 10}}, {2.005, 5, -5}),
                          MakeObject(BoxShape{{0.01, 40, 40}}, {2.305, 0, -20})});
  Sensor sensor;
  sensor.tilt_start = sensor.tilt_end = 0.0;
  Noise noise;
  noise.beam_divergence = 1.0 * kDegree;
  noise.rays_per_beam = 61;
  noise.mixing_distance = 0.5;
  const float mixed = LaserScanner(sensor, noise, caster, 1, 0).Scan(0).line.ranges[180];
  EXPECT_GT(mixed, 2.05f);
  EXPECT_LT(mixed, 2.25f);
  noise.mixing_distance = 0.1;  // now one of the two wins
  const float single = LaserScanner(sensor, noise, caster, 1, 0).Scan(0).line.ranges[180];
  EXPECT_TRUE(std::abs(single - 2.0f) < 0.01f || std::abs(single - 2.3f) < 0.01f) << single;
  // Beams clear of the edge are not mixed.
  const LaserLine line = LaserScanner(sensor, noise, caster, 1, 0).Scan(0).line;
  EXPECT_NEAR(line.ranges[200], 2.0 / std::cos(10 * kDegree), 0.01);
  EXPECT_NEAR(line.ranges[160], 2.3 / std::cos(10 * kDegree), 0.01);
}

}  // namespace
}  // namespace rimod::simulation
