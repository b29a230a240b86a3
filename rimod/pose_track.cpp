#include "rimod/pose_track.h"

#include <algorithm>
#include <cassert>

namespace rimod {
namespace {

constexpr std::int64_t kMaxTime = 4000000000000000000;
// m; floats are coarser than the Earth is large beyond it.
constexpr double kMaxPosition = 1e9;

double Microseconds(Time duration) { return static_cast<double>(duration.count()); }

// [axis]x, the matrix of the cross product.
Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& axis) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -axis.z(), axis.y(), axis.z(), 0.0, -axis.x(), -axis.y(), axis.x(), 0.0;
  return matrix;
}

}  // namespace

bool IsUsableTime(Time time) { return time.count() >= -kMaxTime && time.count() <= kMaxTime; }

bool IsUsablePose(const TimedPose& pose) {
  const Eigen::Matrix3d R = pose.T_local_laser.linear();
  const Eigen::Vector3d position = pose.T_local_laser.translation();
  if (!IsUsableTime(pose.time) || !R.allFinite() || !position.allFinite()) return false;
  constexpr double kTolerance = 1e-3;
  const bool orthonormal =
      (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kTolerance;
  return orthonormal && R.determinant() > 0.0 && position.cwiseAbs().maxCoeff() <= kMaxPosition;
}

void PoseTrack::Add(const TimedPose& pose) {
  assert(poses_.empty() || pose.time > poses_.back().time);
  Pose added;
  added.time = pose.time;
  added.position = pose.T_local_laser.translation();
  added.orientation = Eigen::Quaterniond(pose.T_local_laser.linear()).normalized();
  poses_.push_back(added);
}

void PoseTrack::ForgetBefore(Time time) {
  while (poses_.size() > 1 && poses_[1].time <= time) poses_.pop_front();
}

void PoseTrack::ForgetFrom(Time time) {
  while (!poses_.empty() && poses_.back().time >= time) poses_.pop_back();
}

PoseTrack::Coverage PoseTrack::Covers(Time time, double duration, double max_gap) const {
  if (poses_.empty()) return Coverage::kNotYet;
  if (poses_.front().time > time) return Coverage::kNever;
  for (std::size_t i = IndexBefore(time);; ++i) {
    const double reached = Microseconds(poses_[i].time - time);
    if (reached >= duration) return Coverage::kCovered;
    if (i + 1 == poses_.size()) return Coverage::kNotYet;
    if (Microseconds(poses_[i + 1].time - poses_[i].time) > max_gap) return Coverage::kNever;
  }
}

std::size_t PoseTrack::IndexBefore(Time time) const {
  const auto after =
      std::upper_bound(poses_.begin(), poses_.end(), time,
                       [](Time value, const Pose& pose) { return value < pose.time; });
  assert(after != poses_.begin());
  return static_cast<std::size_t>(after - poses_.begin()) - 1;
}

PoseMotion PoseTrack::MotionAfter(std::size_t index, Time reference) const {
  const Pose& from = poses_[index];
  // The newest pose has no motion after it: it stands still for as long as one asks.
  const bool last = index + 1 == poses_.size();
  const Pose& to = last ? from : poses_[index + 1];
  PoseMotion motion;
  motion.begin = Microseconds(from.time - reference);
  motion.end = last ? motion.begin + 1.0 : Microseconds(to.time - reference);
  motion.position = from.position;
  motion.translation = to.position - from.position;
  const Eigen::Quaterniond turn = from.orientation.conjugate() * to.orientation;
  const Eigen::AngleAxisd angle_axis(turn);
  motion.angle = angle_axis.angle();
  const Eigen::Vector3d& axis = angle_axis.axis();
  const Eigen::Matrix3d R = from.orientation.toRotationMatrix();
  const Eigen::Matrix3d along = R * (axis * axis.transpose());
  motion.fixed = along.leftCols<2>();
  motion.cosine = (R - along).leftCols<2>();
  motion.sine = (R * CrossMatrix(axis)).leftCols<2>();
  return motion;
}

Eigen::Isometry3d PoseTrack::At(Time time, double offset) const {
  std::size_t index = IndexBefore(time);
  while (index + 1 < poses_.size() && Microseconds(poses_[index + 1].time - time) <= offset) {
    ++index;
  }
  const Pose& from = poses_[index];
  Eigen::Isometry3d T_local_laser = Eigen::Isometry3d::Identity();
  if (index + 1 == poses_.size()) {
    T_local_laser.linear() = from.orientation.toRotationMatrix();
    T_local_laser.translation() = from.position;
    return T_local_laser;
  }
  const Pose& to = poses_[index + 1];
  const double share =
      (Microseconds(time - from.time) + offset) / Microseconds(to.time - from.time);
  T_local_laser.linear() = from.orientation.slerp(share, to.orientation).toRotationMatrix();
  T_local_laser.translation() = from.position + share * (to.position - from.position);
  return T_local_laser;
}

}  // namespace rimod
