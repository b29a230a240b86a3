#include "rimod/scan.h"

#include <cmath>

namespace rimod {

Eigen::Isometry3d LevelPose(const Eigen::Isometry3d& T_local_any) {
  const Eigen::Vector3d forward = T_local_any.linear().col(0);
  constexpr double kVertical = 1e-6;  // shorter horizontal part: no heading to speak of
  const bool vertical = forward.head<2>().norm() < kVertical;
  const double heading = vertical ? 0.0 : std::atan2(forward.y(), forward.x());
  Eigen::Isometry3d T_local_level = Eigen::Isometry3d::Identity();
  T_local_level.linear() = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T_local_level.translation() = T_local_any.translation();
  return T_local_level;
}

}  // namespace rimod
