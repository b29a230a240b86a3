#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace rimod {

// One 3D scan: what a range sensor saw from (nearly) one place. docs/conventions.md has the frames.
struct Scan {
  // Level sensor frame (x forward, y left, z up, z parallel to the local frame's) to local frame.
  Eigen::Isometry3d T_local_sensor = Eigen::Isometry3d::Identity();
  // Measured points, metres, local frame, finite.
  std::vector<Eigen::Vector3f> points;
  // Unit vectors in the local frame, from the sensor along the beams that came back without a
  // range. Empty where the source does not tell (PCD files leave such beams out).
  std::vector<Eigen::Vector3f> no_return_directions;
};

// The level pose at T's position: keeps the heading of T's x-axis and makes z parallel to the
// world's. A vertical x-axis gives heading 0.
Eigen::Isometry3d LevelPose(const Eigen::Isometry3d& T_local_any);

}  // namespace rimod
