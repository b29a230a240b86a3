#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <optional>

#include "rimod/sweep.h"

namespace rimod {

// False for times beyond +- 120,000 years: they are garbage, and differences of them overflow.
bool IsUsableTime(Time time);
// False for poses that are not finite, no rotation, absurdly far away or of an unusable time.
bool IsUsablePose(const TimedPose& pose);

// How the laser moves between two neighbouring poses: its position at constant velocity (lerp), its
// attitude at constant turn rate (slerp). Times in microseconds after some reference time.
//
// Rodrigues' formula, written so that a beam costs no trigonometry beyond cos and sin of the turn
// phi made so far: the first two columns of R_local_laser(phi) are fixed + cos(phi) * cosine +
// sin(phi) * sine. Beams of a line have no z component, so two columns are enough.
struct PoseMotion {
  double begin = 0.0;                                     // us
  double end = 0.0;                                       // us, > begin
  double angle = 0.0;                                     // rad, turn from begin to end, 0 .. pi
  Eigen::Vector3d position = Eigen::Vector3d::Zero();     // m, local frame, at begin
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // m, from begin to end
  Eigen::Matrix<double, 3, 2> fixed, cosine, sine;

  double Share(double time) const { return (time - begin) / (end - begin); }
};

// The poses of the last while, in the order of time, and the motion between them.
class PoseTrack {
 public:
  enum class Coverage { kCovered, kNotYet, kNever };

  bool empty() const { return poses_.empty(); }
  std::size_t size() const { return poses_.size(); }
  // Time of the newest pose; the track must not be empty.
  Time newest() const { return poses_.back().time; }

  // pose must be later than all others.
  void Add(const TimedPose& pose);
  // Forgets the poses that nothing at or after this time needs.
  void ForgetBefore(Time time);
  // Forgets the poses at or after this time.
  void ForgetFrom(Time time);
  void ForgetOldest() { poses_.pop_front(); }
  void Clear() { poses_.clear(); }

  // Whether [time, time + duration] lies between poses that are at most max_gap (us) apart; kNotYet
  // when a later pose can still make it so. duration in us.
  Coverage Covers(Time time, double duration, double max_gap) const;

  // The poses' index before or at this time; the time must be covered.
  std::size_t IndexBefore(Time time) const;
  // Motion from pose index to the next one, times after reference.
  PoseMotion MotionAfter(std::size_t index, Time reference) const;
  // Interpolated pose at time + offset (us), which must be covered.
  Eigen::Isometry3d At(Time time, double offset) const;

 private:
  struct Pose {
    Time time{0};
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  };
  std::deque<Pose> poses_;
};

}  // namespace rimod
