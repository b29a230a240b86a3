#include "rimod/absolute_orientation.h"

#include <Eigen/Eigenvalues>
#include <stdexcept>

namespace rimod {

Eigen::Isometry3d AbsoluteOrientation(const std::vector<Eigen::Vector3d>& from,
                                      const std::vector<Eigen::Vector3d>& to) {
  if (from.size() != to.size() || from.empty())
    throw std::invalid_argument("absolute orientation of point lists of different or no length");
  Eigen::Vector3d from_mean = Eigen::Vector3d::Zero(), to_mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    from_mean += from[i];
    to_mean += to[i];
  }
  from_mean /= static_cast<double>(from.size());
  to_mean /= static_cast<double>(to.size());

  // Horn, section 4.A: M holds the sums of products of coordinates, N is symmetric and its
  // eigenvector of the largest eigenvalue is the rotation.
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i)
    M += (from[i] - from_mean) * (to[i] - to_mean).transpose();
  const Eigen::Vector3d cross(M(1, 2) - M(2, 1), M(2, 0) - M(0, 2), M(0, 1) - M(1, 0));
  Eigen::Matrix4d N;
  N(0, 0) = M.trace();
  N.block<1, 3>(0, 1) = cross.transpose();
  N.block<3, 1>(1, 0) = cross;
  N.block<3, 3>(1, 1) = M + M.transpose() - M.trace() * Eigen::Matrix3d::Identity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(N);
  const Eigen::Vector4d q = solver.eigenvectors().col(3);

  Eigen::Isometry3d T_to_from = Eigen::Isometry3d::Identity();
  T_to_from.linear() = Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized().toRotationMatrix();
  T_to_from.translation() = to_mean - T_to_from.linear() * from_mean;
  return T_to_from;
}

}  // namespace rimod
