#include "rimod/cloud_placer.h"

#include <utility>

#include "rimod/check.h"

namespace rimod {
namespace {

constexpr std::size_t kMaxWaiting = 8;     // clouds; at ten a second far longer than max_pose_gap
constexpr std::size_t kMaxPoses = 100000;  // kept while they wait for a cloud
constexpr Time kClockJump(500000);         // a stream that goes back by more begins anew

enum class Order { kNext, kUnordered, kJump };

Order OrderOf(Time time, const std::optional<Time>& last) {
  if (!last || time > *last) return Order::kNext;
  return *last - time < kClockJump ? Order::kUnordered : Order::kJump;
}

}  // namespace

void CloudParams::Validate() const {
  constexpr double kFarthest = 1000.0;
  constexpr double kTurn = 6.2831853071795865;
  CheckWithin("cloud mount_x", mount_x, -kFarthest, kFarthest);
  CheckWithin("cloud mount_y", mount_y, -kFarthest, kFarthest);
  CheckWithin("cloud mount_z", mount_z, -kFarthest, kFarthest);
  CheckWithin("cloud mount_roll", mount_roll, -kTurn, kTurn);
  CheckWithin("cloud mount_pitch", mount_pitch, -kTurn, kTurn);
  CheckWithin("cloud mount_yaw", mount_yaw, -kTurn, kTurn);
  CheckWithin("cloud max_pose_gap", max_pose_gap, 1e-3, 3600.0);
}

Eigen::Isometry3d MountPose(const CloudParams& params) {
  Eigen::Isometry3d T_carrier_sensor = Eigen::Isometry3d::Identity();
  T_carrier_sensor.linear() = (Eigen::AngleAxisd(params.mount_yaw, Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(params.mount_pitch, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(params.mount_roll, Eigen::Vector3d::UnitX()))
                                  .toRotationMatrix();
  T_carrier_sensor.translation() = Eigen::Vector3d(params.mount_x, params.mount_y, params.mount_z);
  return T_carrier_sensor;
}

CloudPlacer::CloudPlacer(const CloudParams& params, bool with_poses)
    : params_((params.Validate(), params)),
      with_poses_(with_poses),
      T_carrier_sensor_(MountPose(params)) {}

std::vector<PlacedCloud> CloudPlacer::AddCloud(SensorCloud cloud) {
  if (!IsUsableTime(cloud.time)) {
    ++counters_.bad_clouds;
    return {};
  }
  const Order order = OrderOf(cloud.time, last_cloud_);
  if (order == Order::kUnordered) {
    ++counters_.unordered_clouds;
    return {};
  }
  if (order == Order::kJump) {
    counters_.clouds_without_pose += static_cast<std::int64_t>(waiting_.size());
    waiting_.clear();
  }
  last_cloud_ = cloud.time;
  if (!with_poses_) return {Place(cloud, Eigen::Isometry3d::Identity())};
  waiting_.push_back(std::move(cloud));
  if (waiting_.size() > kMaxWaiting) {
    waiting_.pop_front();
    ++counters_.clouds_without_pose;
  }
  return PlaceWaiting();
}

std::vector<PlacedCloud> CloudPlacer::AddPose(const TimedPose& T_local_carrier) {
  if (!IsUsablePose(T_local_carrier)) {
    ++counters_.bad_poses;
    return {};
  }
  const std::optional<Time> newest =
      poses_.empty() ? std::nullopt : std::optional<Time>(poses_.newest());
  const Order order = OrderOf(T_local_carrier.time, newest);
  if (order == Order::kUnordered) {
    ++counters_.unordered_poses;
    return {};
  }
  if (order == Order::kJump) poses_.Clear();
  poses_.Add(T_local_carrier);
  if (poses_.size() > kMaxPoses) poses_.ForgetOldest();
  return PlaceWaiting();
}

PlacedCloud CloudPlacer::Place(const SensorCloud& cloud, const Eigen::Isometry3d& T_local_carrier) {
  const Eigen::Isometry3d T_local_sensor = T_local_carrier * T_carrier_sensor_;
  PlacedCloud placed;
  placed.time = cloud.time;
  placed.scan.T_local_sensor = LevelPose(T_local_sensor);
  placed.scan.points.reserve(cloud.points.size());
  for (const Eigen::Vector3f& p_sensor : cloud.points) {
    const Eigen::Vector3f p_local = (T_local_sensor * p_sensor.cast<double>()).cast<float>();
    if (p_local.allFinite()) placed.scan.points.push_back(p_local);
  }
  ++counters_.clouds;
  return placed;
}

std::vector<PlacedCloud> CloudPlacer::PlaceWaiting() {
  std::vector<PlacedCloud> placed;
  while (!waiting_.empty()) {
    const Time time = waiting_.front().time;
    const PoseTrack::Coverage coverage = poses_.Covers(time, 0.0, params_.max_pose_gap * 1e6);
    if (coverage == PoseTrack::Coverage::kNotYet) break;
    if (coverage == PoseTrack::Coverage::kCovered) {
      placed.push_back(Place(waiting_.front(), poses_.At(time, 0.0)));
    } else {
      ++counters_.clouds_without_pose;
    }
    waiting_.pop_front();
  }
  // Clouds to come are later than the last one.
  if (last_cloud_) poses_.ForgetBefore(waiting_.empty() ? *last_cloud_ : waiting_.front().time);
  return placed;
}

}  // namespace rimod
