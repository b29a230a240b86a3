#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "rimod/pose_track.h"
#include "rimod/scan.h"
#include "rimod/sweep.h"

namespace rimod {

// Where a sensor that delivers whole scans as point clouds is mounted: T_carrier_sensor, the turns
// about z (yaw), then y (pitch), then x (roll). The carrier's pose in the local frame comes with
// the clouds; without one the carrier's frame is the local frame. z of the local frame points up.
struct CloudParams {
  double mount_x = 0.0;       // m, sensor in the carrier's frame; -1000 .. 1000
  double mount_y = 0.0;       // m
  double mount_z = 0.0;       // m
  double mount_roll = 0.0;    // rad; -2 pi .. 2 pi
  double mount_pitch = 0.0;   // rad, > 0 looks down
  double mount_yaw = 0.0;     // rad, > 0 looks left
  double max_pose_gap = 0.2;  // s, poses farther apart are not interpolated; > 0 .. 3600
  void Validate() const;      // throws std::invalid_argument naming field and value
};

// The mount as a pose: sensor frame to carrier frame.
Eigen::Isometry3d MountPose(const CloudParams& params);

// What a range sensor saw at one time.
struct SensorCloud {
  Time time{0};
  std::vector<Eigen::Vector3f> points;  // m, sensor frame, finite; the sensor's origin is no point
};

struct PlacedCloud {
  Time time{0};
  Scan scan;  // without beams that gave no return: clouds do not tell them
};

// What was left out so far, by cause.
struct CloudCounters {
  std::int64_t clouds = 0;               // placed
  std::int64_t bad_clouds = 0;           // time is absurd
  std::int64_t unordered_clouds = 0;     // repeated or older than one already taken
  std::int64_t clouds_without_pose = 0;  // no pose before or none after within max_pose_gap
  std::int64_t bad_poses = 0;            // not finite, no rotation, absurdly far away
  std::int64_t unordered_poses = 0;
};

// Brings clouds into the local frame, each by the carrier's pose at its time, interpolated between
// the poses before and after it. So the result depends on the measurements only, not on when they
// arrive. A cloud is taken as measured at one moment. A clock that ran backwards by half a second
// or more begins anew.
class CloudPlacer {
 public:
  // with_poses: wait for poses; else the carrier's frame is the local frame. Throws
  // std::invalid_argument for parameters out of range.
  CloudPlacer(const CloudParams& params, bool with_poses);

  // Each returns the clouds that can be placed now, oldest first. At most a few wait for a pose: a
  // further one pushes the oldest out.
  std::vector<PlacedCloud> AddCloud(SensorCloud cloud);
  std::vector<PlacedCloud> AddPose(const TimedPose& T_local_carrier);

  const CloudCounters& counters() const { return counters_; }

 private:
  PlacedCloud Place(const SensorCloud& cloud, const Eigen::Isometry3d& T_local_carrier);
  std::vector<PlacedCloud> PlaceWaiting();

  CloudParams params_;
  bool with_poses_;
  Eigen::Isometry3d T_carrier_sensor_;
  CloudCounters counters_;
  PoseTrack poses_;
  std::deque<SensorCloud> waiting_;  // oldest first
  std::optional<Time> last_cloud_;   // taken, for the order of clouds
};

}  // namespace rimod
