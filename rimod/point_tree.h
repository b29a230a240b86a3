#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace rimod {

// Exact nearest neighbours among 3D points, in a kd-tree. Keeps its own copy of the points.
class PointTree {
 public:
  explicit PointTree(std::vector<Eigen::Vector3d> points);
  ~PointTree();
  PointTree(PointTree&&) noexcept;
  PointTree& operator=(PointTree&&) noexcept;

  const std::vector<Eigen::Vector3d>& points() const;
  // Indices of the points nearer than radius (m), rising.
  std::vector<int> Within(const Eigen::Vector3d& query, double radius) const;
  // Distance (m) to the k-th nearest point, k >= 1, the query itself counting when it is one of the
  // points; infinite when there are fewer.
  double DistanceToNearest(const Eigen::Vector3d& query, int k) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rimod
