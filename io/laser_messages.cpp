#include "io/laser_messages.h"

#include <cmath>

#include "io/pose_messages.h"

namespace rimod {

LaserLineFromMessage FromMessage(const bot_core::planar_lidar_t& message) {
  if (message.nranges < 0 || message.nintensities < 0 ||
      message.ranges.size() != static_cast<std::size_t>(message.nranges) ||
      message.intensities.size() != static_cast<std::size_t>(message.nintensities)) {
    return {std::nullopt, "a count does not fit its list"};
  }
  if (message.nranges == 0) return {std::nullopt, "a line without a beam"};
  if (!std::isfinite(message.rad0) || !std::isfinite(message.radstep)) {
    return {std::nullopt, "an angle is not finite"};
  }
  LaserLine line;
  line.time = Time(message.utime);
  line.first_angle = static_cast<double>(message.rad0);
  line.angle_step = static_cast<double>(message.radstep);
  line.ranges = message.ranges;
  return {std::move(line), ""};
}

TimedPoseFromMessage FromMessage(const bot_core::rigid_transform_t& message) {
  const std::optional<Eigen::Isometry3d> T_local_laser = PoseFrom(message.trans, message.quat);
  if (!T_local_laser) return {std::nullopt, "not a pose"};
  return {TimedPose{Time(message.utime), *T_local_laser}, ""};
}

bot_core::planar_lidar_t ToMessage(const LaserLine& line) {
  bot_core::planar_lidar_t message = {};
  message.utime = line.time.count();
  message.ranges = line.ranges;
  message.nranges = static_cast<std::int32_t>(line.ranges.size());
  message.rad0 = static_cast<float>(line.first_angle);
  message.radstep = static_cast<float>(line.angle_step);
  return message;
}

bot_core::rigid_transform_t ToMessage(const TimedPose& pose) {
  bot_core::rigid_transform_t message = {};
  message.utime = pose.time.count();
  SetPosition(pose.T_local_laser.translation(), message.trans);
  SetOrientation(QuaternionOf(pose.T_local_laser), message.quat);
  return message;
}

}  // namespace rimod
