#include "io/pose_messages.h"

#include <algorithm>
#include <cmath>

#include "rimod/scan.h"

namespace rimod {
namespace {

constexpr double kMaxLengthError = 0.01;  // of a quaternion: rounding to float, not another thing

bool IsFinite(const double* values, int count) {
  return std::all_of(values, values + count, [](double value) { return std::isfinite(value); });
}

std::optional<Eigen::Quaterniond> UnitQuaternion(const double orientation[4]) {
  if (!IsFinite(orientation, 4)) return std::nullopt;
  const Eigen::Quaterniond q(orientation[0], orientation[1], orientation[2], orientation[3]);
  if (!(std::abs(q.norm() - 1.0) <= kMaxLengthError)) return std::nullopt;
  return q.normalized();
}

Eigen::Matrix3d TurnAboutZ(double heading) {
  return Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

// x moved by that many representable numbers.
double Nudged(double x, int steps) {
  const double target = steps < 0 ? -HUGE_VAL : HUGE_VAL;
  for (int i = 0; i < std::abs(steps); ++i) x = std::nextafter(x, target);
  return x;
}

// The heading whose turn about z is R to the last bit, or the nearest where R is no such turn.
double ExactHeading(const Eigen::Matrix3d& R) {
  const double heading = std::atan2(R(1, 0), R(0, 0));
  constexpr int kReach = 4;  // rounding of sin, cos and atan2 together is less
  for (int distance = 0; distance <= kReach; ++distance) {
    for (const int steps : {distance, -distance}) {
      if (TurnAboutZ(Nudged(heading, steps)) == R) return Nudged(heading, steps);
    }
  }
  return heading;
}

double HeadingOf(double w, double z) {
  return w < 0.0 ? 2.0 * std::atan2(-z, -w) : 2.0 * std::atan2(z, w);
}

}  // namespace

std::array<double, 4> QuaternionOf(const Eigen::Isometry3d& T) {
  Eigen::Quaterniond q(T.linear());
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return {q.w(), q.x(), q.y(), q.z()};
}

std::array<double, 4> LevelQuaternionOf(const Eigen::Isometry3d& T) {
  double heading = ExactHeading(T.linear());
  if (TurnAboutZ(heading) != T.linear()) heading = ExactHeading(LevelPose(T).linear());
  const double w = std::max(0.0, std::cos(0.5 * heading));
  const double z = std::sin(0.5 * heading);
  // The halves are rounded, so that their angle may be the heading's neighbour: among the numbers
  // next to them is a pair that gives the very heading.
  constexpr int kReach = 3;
  for (int distance = 0; distance <= kReach; ++distance) {
    for (int dz = -distance; dz <= distance; ++dz) {
      for (const int dw : {distance - std::abs(dz), std::abs(dz) - distance}) {
        const double nudged_w = Nudged(w, dw);
        const double nudged_z = Nudged(z, dz);
        if (nudged_w >= 0.0 && HeadingOf(nudged_w, nudged_z) == heading) {
          return {nudged_w, 0.0, 0.0, nudged_z};
        }
      }
    }
  }
  return {w, 0.0, 0.0, z};
}

std::optional<Eigen::Isometry3d> PoseFrom(const double position[3], const double orientation[4]) {
  const std::optional<Eigen::Quaterniond> q = UnitQuaternion(orientation);
  if (!q || !IsFinite(position, 3)) return std::nullopt;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = q->toRotationMatrix();
  T.translation() = Eigen::Vector3d(position[0], position[1], position[2]);
  return T;
}

std::optional<Eigen::Isometry3d> LevelPoseFrom(const double position[3],
                                               const double orientation[4]) {
  std::optional<Eigen::Isometry3d> T = PoseFrom(position, orientation);
  if (!T) return std::nullopt;
  const bool about_z = orientation[1] == 0.0 && orientation[2] == 0.0;
  if (!about_z) return LevelPose(*T);
  T->linear() = TurnAboutZ(HeadingOf(orientation[0], orientation[3]));
  return T;
}

void SetPosition(const Eigen::Vector3d& position, double message_field[3]) {
  std::copy(position.data(), position.data() + 3, message_field);
}

void SetOrientation(const std::array<double, 4>& orientation, double message_field[4]) {
  std::copy(orientation.begin(), orientation.end(), message_field);
}

}  // namespace rimod
