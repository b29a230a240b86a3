#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rimod/scan.h"

namespace rimod {

// Time since the epoch of whoever stamped the measurements.
using Time = std::chrono::microseconds;

// One line of a 2D laser scanner.
struct LaserLine {
  Time time{0};               // of the first beam
  double first_angle = 0.0;   // rad, about z from x, of the first beam
  double angle_step = 0.0;    // rad, from one beam to the next
  std::vector<float> ranges;  // m, in the order of measuring
};

struct TimedPose {
  Time time{0};
  Eigen::Isometry3d T_local_laser = Eigen::Isometry3d::Identity();
};

struct SweepParams {
  double line_duration = 0.02667;  // s, one line from its first beam to the next line's; > 0
  int beams_per_line =
      361;                  // beam i is measured at time + i / beams_per_line * line_duration; >= 1
  double min_range = 0.3;   // m, shorter readings hit the robot itself or are dazzled; >= 0
  double max_range = 81.9;  // m, readings at or above are "no return"; > min_range
  double reversal_angle = 0.0175;  // rad, the tilt must come back this far to end a sweep; > 0
  double pause_duration =
      0.5;                    // s, a gap in the lines or a tilt at rest this long ends a sweep; > 0
  double rest_rate = 0.0087;  // rad/s, a tilt slower than this is at rest; >= 0
  double min_sweep_angle = 0.35;  // rad, a sweep that turned less is incomplete; > 0
  double max_missing_share =
      0.05;                   // of a sweep's lines may be missing, else it is incomplete; 0 .. 1
  double max_pose_gap = 0.2;  // s, poses farther apart are not interpolated; > 0
  int max_buffered_lines = 2000;    // lines kept while they wait for a pose; >= 1
  int max_buffered_poses = 100000;  // poses kept while they wait for a line; >= 2
  int max_lines = 20000;            // a sweep longer than this is ended as incomplete; >= 1
  void Validate() const;            // throws std::invalid_argument naming field and value
};

// What a sweep that still goes on has grown by.
struct SweepGrowth {
  Time sweep_begin{0};  // first beam of the sweep: that of the Sweep that it becomes
  int step = 0;         // 0, 1, .. of this sweep
  Time begin{0};        // first beam of the growth
  Time end{0};          // last beam of the growth: what is known of the sweep ends here
  int num_lines = 0;    // of the growth
  Scan scan;            // of the growth alone; its sensor pose is that of the whole sweep so far
};

// A sweep that has ended: by reversal or pause of the tilt, by a pause of the lines, because it was
// too long, because the clock ran backwards, or by Finish().
struct Sweep {
  Time begin{0};              // first beam
  Time end{0};                // last beam
  Scan scan;                  // empty when the sweep is incomplete
  int num_lines = 0;          // placed; those before the tilt moved and after it stopped left out
  int num_missing_lines = 0;  // holes in the lines' times
  double turned_angle = 0.0;  // rad, by which the tilt turned; > 0 downwards
  std::string incomplete_reason;  // empty: the sweep is complete and scan can be used
  bool complete() const { return incomplete_reason.empty(); }
  // What no growth has told yet, perhaps no lines: growths and this one after the other are the
  // scan. Nothing where no growth was taken, where they hold more than the sweep (its last lines
  // belong to the next one) and where the sweep is incomplete.
  std::optional<SweepGrowth> rest;
};

// The end of a sweep, and what all its growths together must be to be its scan.
struct SweepEnd {
  Time begin{0};  // first beam
  Time end{0};    // last beam
  int num_steps = 0;
  int num_lines = 0;
  int num_missing_lines = 0;
  std::size_t num_points = 0;
  std::size_t num_no_returns = 0;
  Eigen::Isometry3d T_local_sensor = Eigen::Isometry3d::Identity();  // of the scan
};

// What was taken and left out so far, by cause. All of it is counted, nothing of it stops the
// assembler.
struct SweepCounters {
  std::int64_t lines = 0;               // placed
  std::int64_t poses = 0;               // taken
  std::int64_t bad_lines = 0;           // empty, angles not finite, more beams than a turn holds
  std::int64_t bad_poses = 0;           // not finite, no rotation, absurdly far away
  std::int64_t unordered_lines = 0;     // repeated or older than one already taken
  std::int64_t unordered_poses = 0;     // likewise
  std::int64_t lines_without_pose = 0;  // no pose before or none after within max_pose_gap
  std::int64_t idle_lines = 0;          // placed, but the tilt rested: part of no sweep
  std::int64_t bad_ranges = 0;          // NaN, negative
  std::int64_t near_ranges = 0;         // below min_range
  std::int64_t missing_lines = 0;       // holes shorter than a pause
  std::int64_t crowded_lines = 0;       // sooner after the one before than one laser sends them
  std::int64_t clock_jumps = 0;         // time ran backwards by a pause or more
  std::int64_t complete_sweeps = 0;
  std::int64_t incomplete_sweeps = 0;
};

}  // namespace rimod
