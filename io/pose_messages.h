#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

namespace rimod {

// The only place where poses and quaternions of messages (w, x, y, z) meet.

// Unit quaternion w, x, y, z of a pose's rotation, w >= 0. The same for messages, files and text.
std::array<double, 4> QuaternionOf(const Eigen::Isometry3d& T);

// The quaternion of a level pose (a turn about z) from which LevelPoseFrom() gives T back bit for
// bit. Of another pose the quaternion of LevelPose(T).
std::array<double, 4> LevelQuaternionOf(const Eigen::Isometry3d& T);

// Pose from a message. Nothing when a value is not finite or the quaternion's length is not within
// 1 % of 1; it is normalised.
std::optional<Eigen::Isometry3d> PoseFrom(const double position[3], const double orientation[4]);

// The same for poses that are turns about z; others are made level (LevelPose).
std::optional<Eigen::Isometry3d> LevelPoseFrom(const double position[3],
                                               const double orientation[4]);

void SetPosition(const Eigen::Vector3d& position, double message_field[3]);
void SetOrientation(const std::array<double, 4>& orientation, double message_field[4]);

}  // namespace rimod
