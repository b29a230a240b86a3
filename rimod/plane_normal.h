#pragma once

#include <Eigen/Core>

namespace rimod {

// The eigenvector of the smallest eigenvalue of a covariance (m^2; symmetric, not negative): the
// normal of the plane through points spread like that, unit, of either sign. Zero where that is no
// one direction: all points in one place or on a line. Several times faster than an eigenvalue
// solver, and exact to float's rounding where the second eigenvalue is well above the smallest.
Eigen::Vector3f PlaneNormal(const Eigen::Matrix3f& covariance);

}  // namespace rimod
