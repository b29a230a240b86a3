#include "tests/support/tilting_laser.h"

#include <cmath>

#include "io/laser_messages.h"

namespace rimod {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kLineDuration = 0.02667;  // s
constexpr int kNumBeams = 181;
constexpr int kBeamsPerLine = 361;  // that many would fit into a line's time
constexpr double kStep = 0.5 * kDegree;

Eigen::Isometry3d PoseAt(double line) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() =
      Eigen::AngleAxisd((-15.0 + 0.75 * line) * kDegree, Eigen::Vector3d::UnitY()).matrix();
  T.translation() = Eigen::Vector3d(0.0, 0.0, 1.0);
  return T;
}

Time TimeOf(Time begin, double line) {
  return begin + Time(std::llround(line * kLineDuration * 1e6));
}

}  // namespace

TiltingLaser TiltInFrontOf(const World& world, Time begin, int num_lines) {
  TiltingLaser laser;
  for (int line = 0; line <= num_lines; ++line) {
    laser.poses.push_back(ToMessage(TimedPose{TimeOf(begin, line), PoseAt(line)}));
  }
  for (int line = 0; line < num_lines; ++line) {
    LaserLine measured;
    measured.time = TimeOf(begin, line);
    measured.first_angle = -0.5 * (kNumBeams - 1) * kStep;
    measured.angle_step = kStep;
    for (int beam = 0; beam < kNumBeams; ++beam) {
      const double angle = measured.first_angle + beam * kStep;
      const Eigen::Isometry3d T_local_laser =
          PoseAt(line + static_cast<double>(beam) / kBeamsPerLine);
      const Eigen::Vector3d direction =
          T_local_laser.linear() * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
      constexpr double kNoReturn = 81.91;
      measured.ranges.push_back(static_cast<float>(
          CastBeam(world, T_local_laser.translation(), direction).value_or(kNoReturn)));
    }
    laser.lines.push_back(ToMessage(measured));
  }
  return laser;
}

std::vector<Sweep> Assemble(const TiltingLaser& laser, const SweepParams& params) {
  SweepAssembler assembler(params);
  std::vector<Sweep> sweeps;
  const auto append = [&sweeps](std::vector<Sweep> ended) {
    for (Sweep& sweep : ended) sweeps.push_back(std::move(sweep));
  };
  for (const bot_core::rigid_transform_t& pose : laser.poses) {
    append(assembler.AddPose(FromMessage(pose).pose.value()));
  }
  for (const bot_core::planar_lidar_t& line : laser.lines) {
    append(assembler.AddLine(FromMessage(line).line.value()));
  }
  append(assembler.Finish());
  return sweeps;
}

World SmallRoom() {
  World world;
  world.planes.push_back({Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()});
  world.planes.push_back({Eigen::Vector3d(5.0, 0.0, 0.0), -Eigen::Vector3d::UnitX()});
  world.spheres.push_back({Eigen::Vector3d(2.5, 0.6, 0.4), 0.4});
  world.boxes.push_back({Placed(2.2, -0.5, 0.35, 0.3), Eigen::Vector3d(0.3, 0.25, 0.35)});
  return world;
}

}  // namespace rimod
