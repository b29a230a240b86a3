#include "tests/support/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "rimod/range_image.h"

namespace rimod {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

double Distance(const PlaneShape& plane, const Eigen::Vector3d& origin,
                const Eigen::Vector3d& direction) {
  const double slope = plane.normal.dot(direction);
  if (slope == 0.0) return kNone;
  const double distance = plane.normal.dot(plane.point - origin) / slope;
  return distance > 0.0 ? distance : kNone;
}

double Distance(const SphereShape& sphere, const Eigen::Vector3d& origin,
                const Eigen::Vector3d& direction) {
  const Eigen::Vector3d to_centre = sphere.centre - origin;
  const double along = to_centre.dot(direction);
  const double beside_sq = to_centre.squaredNorm() - along * along;
  const double half_chord_sq = sphere.radius * sphere.radius - beside_sq;
  if (half_chord_sq < 0.0) return kNone;
  const double half_chord = std::sqrt(half_chord_sq);
  if (along - half_chord > 0.0) return along - half_chord;
  return along + half_chord > 0.0 ? along + half_chord : kNone;
}

double Distance(const BoxShape& box, const Eigen::Vector3d& origin,
                const Eigen::Vector3d& direction) {
  const Eigen::Isometry3d T_box_local = box.T_local_box.inverse();
  const Eigen::Vector3d o = T_box_local * origin;
  const Eigen::Vector3d d = T_box_local.linear() * direction;
  double enter = -kNone, leave = kNone;
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0.0) {
      if (std::abs(o[axis]) > box.half_size[axis]) return kNone;
      continue;
    }
    const double a = (-box.half_size[axis] - o[axis]) / d[axis];
    const double b = (box.half_size[axis] - o[axis]) / d[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter > leave || leave <= 0.0) return kNone;
  return enter > 0.0 ? enter : leave;
}

struct Readings {
  double max_range = 0.0, noise = 0.0;  // m
  std::uint32_t seed = 1;
};

// Of beams in the sensor frame.
Scan ScanAlong(const std::vector<Eigen::Vector3d>& beams, const World& world,
               const Eigen::Isometry3d& T_local_sensor, const Readings& readings) {
  std::mt19937 random(readings.seed);
  std::normal_distribution<double> noise(0.0, std::max(readings.noise, 1e-12));
  Scan scan;
  scan.T_local_sensor = T_local_sensor;
  for (const Eigen::Vector3d& beam_sensor : beams) {
    const Eigen::Vector3d beam = T_local_sensor.linear() * beam_sensor;
    const std::optional<double> range = CastBeam(world, T_local_sensor.translation(), beam);
    if (range && *range < readings.max_range) {
      const double measured = *range + (readings.noise > 0.0 ? noise(random) : 0.0);
      scan.points.push_back((T_local_sensor.translation() + measured * beam).cast<float>());
    } else {
      scan.no_return_directions.push_back(beam.cast<float>());
    }
  }
  return scan;
}

}  // namespace

std::optional<double> CastBeam(const World& world, const Eigen::Vector3d& origin,
                               const Eigen::Vector3d& direction) {
  double nearest = kNone;
  for (const PlaneShape& plane : world.planes)
    nearest = std::min(nearest, Distance(plane, origin, direction));
  for (const SphereShape& sphere : world.spheres)
    nearest = std::min(nearest, Distance(sphere, origin, direction));
  for (const BoxShape& box : world.boxes)
    nearest = std::min(nearest, Distance(box, origin, direction));
  if (nearest == kNone) return std::nullopt;
  return nearest;
}

Scan ScanWorld(const World& world, const Eigen::Isometry3d& T_local_sensor,
               const BeamPattern& pattern) {
  std::vector<Eigen::Vector3d> beams;
  const int columns =
      1 + static_cast<int>((pattern.azimuth_max - pattern.azimuth_min) / pattern.step);
  const int rows =
      1 + static_cast<int>((pattern.elevation_max - pattern.elevation_min) / pattern.step);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      beams.push_back(UnitVector({pattern.azimuth_min + column * pattern.step,
                                  pattern.elevation_min + row * pattern.step}));
    }
  }
  return ScanAlong(beams, world, T_local_sensor, {pattern.max_range, pattern.noise, pattern.seed});
}

Scan ScanWorld(const World& world, const Eigen::Isometry3d& T_local_sensor,
               const CameraPattern& pattern) {
  const Eigen::AngleAxisd R_sensor_camera(pattern.pitch, Eigen::Vector3d::UnitY());
  std::vector<Eigen::Vector3d> beams;
  for (int row = 0; row < pattern.height; ++row) {
    for (int column = 0; column < pattern.width; ++column) {
      const Eigen::Vector3d p_camera(pattern.focal, 0.5 * pattern.width - column - 0.5,
                                     0.5 * pattern.height - row - 0.5);
      beams.push_back(R_sensor_camera * p_camera.normalized());
    }
  }
  return ScanAlong(beams, world, T_local_sensor, {pattern.max_range, pattern.noise, pattern.seed});
}

Eigen::Isometry3d LookAt(const Eigen::Vector3d& position, const Eigen::Vector3d& target) {
  const Eigen::Vector3d forward = target - position;
  return Placed(position.x(), position.y(), position.z(), std::atan2(forward.y(), forward.x()));
}

Eigen::Isometry3d Placed(double x, double y, double z, double heading) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x, y, z);
  return T;
}

}  // namespace rimod
