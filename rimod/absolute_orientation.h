#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace rimod {

// The rigid transformation T that minimises sum |T from[i] - to[i]|^2, by Horn's closed form with
// unit quaternions (Horn 1987; paper, section III-B). At least three points that are not collinear,
// else the rotation is any of the optimal ones. Throws std::invalid_argument for lists of different
// or no length.
Eigen::Isometry3d AbsoluteOrientation(const std::vector<Eigen::Vector3d>& from,
                                      const std::vector<Eigen::Vector3d>& to);

}  // namespace rimod
