#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "rimod/scan.h"

namespace rimod {

// Surfaces whose intersection with a beam is known exactly, and a scanner for them: tests make the
// scenes that they need. All in the local frame, metres.

struct PlaneShape {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

struct SphereShape {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 1.0;
};

struct BoxShape {
  Eigen::Isometry3d T_local_box = Eigen::Isometry3d::Identity();  // origin in the middle
  Eigen::Vector3d half_size = Eigen::Vector3d::Ones();
};

struct World {
  std::vector<PlaneShape> planes;
  std::vector<SphereShape> spheres;
  std::vector<BoxShape> boxes;
};

// Distance to the nearest surface along a unit direction; nothing when the beam meets none.
std::optional<double> CastBeam(const World& world, const Eigen::Vector3d& origin,
                               const Eigen::Vector3d& direction);

// Beams in even steps of azimuth and elevation in the level sensor frame, rad.
struct BeamPattern {
  double azimuth_min = -0.8, azimuth_max = 0.8;
  double elevation_min = -0.6, elevation_max = 0.4;
  double step = 0.0069;
  double max_range = 80.0;  // m, farther surfaces give no return
  double noise = 0.0;       // m, standard deviation of the ranges
  std::uint32_t seed = 1;   // of the noise
};

// What a scanner at the pose sees of the world.
Scan ScanWorld(const World& world, const Eigen::Isometry3d& T_local_sensor,
               const BeamPattern& pattern);

// A depth camera: square pixels about an optical axis that lies in the level sensor frame's x-z
// plane.
struct CameraPattern {
  double pitch = 0.0;  // rad, down
  int width = 160, height = 120;
  double focal = 140.0;     // pixels
  double max_range = 80.0;  // m
  double noise = 0.0;       // m, standard deviation of the ranges
  std::uint32_t seed = 1;
};

Scan ScanWorld(const World& world, const Eigen::Isometry3d& T_local_sensor,
               const CameraPattern& pattern);

// A level sensor at the position that looks towards the target.
Eigen::Isometry3d LookAt(const Eigen::Vector3d& position, const Eigen::Vector3d& target);

// A pose that turns about z and moves.
Eigen::Isometry3d Placed(double x, double y, double z, double heading);

}  // namespace rimod
