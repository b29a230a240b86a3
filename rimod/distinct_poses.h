#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace rimod {

// Poses of a model of which no two are the same; numbered as they come.
class DistinctPoses {
 public:
  // Two poses are the same when the model's centres are nearer than same_distance (m) and they are
  // turned by less than same_angle (rad) against each other.
  DistinctPoses(double same_distance, double same_angle);

  // Number of the first pose that is the same; a new one is added and gets the next number. centre:
  // of the model at that pose, m, finite.
  int FindOrAdd(const Eigen::Isometry3f& T_sensor_object, const Eigen::Vector3f& centre);

 private:
  struct Pose {
    Eigen::Matrix3f rotation;
    Eigen::Vector3f centre;
  };

  bool Same(const Pose& a, const Pose& b) const;
  Eigen::Vector3i CellOf(const Eigen::Vector3f& p) const;

  float distance_, min_trace_;
  std::vector<Pose> poses_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;  // by place
};

}  // namespace rimod
