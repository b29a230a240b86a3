#include "rimod/distinct_poses.h"

#include <cmath>

namespace rimod {
namespace {

std::uint64_t Key(const Eigen::Vector3i& cell) {
  constexpr std::uint64_t kMixing = 0x9E3779B97F4A7C15u;  // golden ratio times 2^64
  std::uint64_t key = 0;
  for (int d = 0; d < 3; ++d) key = key * kMixing + static_cast<std::uint32_t>(cell[d]);
  return key;
}

}  // namespace

DistinctPoses::DistinctPoses(double same_distance, double same_angle)
    : distance_(static_cast<float>(same_distance)),
      min_trace_(1.0f + 2.0f * static_cast<float>(std::cos(same_angle))) {}

int DistinctPoses::FindOrAdd(const Eigen::Isometry3f& T_sensor_object,
                             const Eigen::Vector3f& centre) {
  const Pose pose{T_sensor_object.linear(), centre};
  // Cells are two distances wide: a ball reaches into eight of them at most.
  const Eigen::Vector3i low = CellOf(centre.array() - distance_);
  const Eigen::Vector3i high = CellOf(centre.array() + distance_);
  const int count = static_cast<int>(poses_.size());
  int found = count;
  for (int x = low.x(); x <= high.x(); ++x) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int z = low.z(); z <= high.z(); ++z) {
        const auto cell = cells_.find(Key({x, y, z}));
        if (cell == cells_.end()) continue;
        for (const int k : cell->second)
          if (k < found && Same(poses_[k], pose)) found = k;
      }
    }
  }
  if (found < count) return found;
  cells_[Key(CellOf(centre))].push_back(count);
  poses_.push_back(pose);
  return count;
}

bool DistinctPoses::Same(const Pose& a, const Pose& b) const {
  return (a.centre - b.centre).squaredNorm() < distance_ * distance_ &&
         a.rotation.cwiseProduct(b.rotation).sum() > min_trace_;
}

Eigen::Vector3i DistinctPoses::CellOf(const Eigen::Vector3f& p) const {
  constexpr float kFar = 1e6f;  // cells; keeps the conversion defined
  return (p / (2.0f * distance_)).array().floor().max(-kFar).min(kFar).cast<int>();
}

}  // namespace rimod
