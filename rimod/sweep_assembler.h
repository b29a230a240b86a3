#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "rimod/line_placer.h"
#include "rimod/pose_track.h"
#include "rimod/sweep.h"
#include "rimod/sweep_collector.h"

namespace rimod {

// Joins laser lines and the poses of a tilting laser into sweeps (paper, section V: a laser on a
// pan-tilt unit). Each beam is placed by the pose at its own time, interpolated between the poses
// before and after it. Lines and poses may arrive interleaved in any order between the two streams;
// each stream itself in the order of time. The result depends on the measurements only, not on when
// they arrive relative to the other stream, as long as neither stream is ahead by more than the
// buffers hold (max_buffered_lines, max_buffered_poses).
//
// A scan's sensor pose: the mean position of the laser over the sweep's lines, with the heading of
// the mean of its forward directions.
class SweepAssembler {
 public:
  // Throws std::invalid_argument for parameters out of range.
  explicit SweepAssembler(const SweepParams& params);

  // Each returns the sweeps that this input ended, oldest first; mostly none.
  std::vector<Sweep> AddLine(LaserLine line);
  std::vector<Sweep> AddPose(const TimedPose& pose);

  // No more input for now: places what can be placed, ends the sweep at hand and forgets lines,
  // poses and times, so that input of any time may follow. Counters go on.
  std::vector<Sweep> Finish();

  // What the sweep at hand has grown by since the last call, when that lasts min_duration (s) or
  // longer; sweeps do not depend on whether this is called. To be called after each input.
  std::optional<SweepGrowth> TakeGrowth(double min_duration) {
    return collector_.TakeGrowth(min_duration);
  }

  // True after an input that took the sweep at hand to where the last sweeps of its direction
  // ended: the same tilt each time. It probably ends here, too.
  bool reached_known_end() const { return collector_.reached_known_end(); }

  // True while lines wait for a pose after them.
  bool has_waiting_lines() const { return !waiting_.empty(); }
  // True while a sweep is being collected.
  bool collecting() const { return !collector_.empty() || !waiting_.empty(); }
  SweepCounters counters() const;

 private:
  void PlaceWaiting(std::vector<Sweep>* ended);
  void HandleLineClockJump(Time to, std::vector<Sweep>* ended);
  void HandlePoseClockJump(Time to, std::vector<Sweep>* ended);
  void GiveUpLines(std::vector<Sweep>* ended);
  void DropWaitingFrom(Time time);

  SweepParams params_;
  SweepCounters counters_;         // without those that the collector counts
  std::deque<LaserLine> waiting_;  // lines whose last beam has no pose after it yet
  PoseTrack poses_;
  LinePlacer placer_;
  SweepCollector collector_;
  std::optional<Time> last_line_;  // taken, for the order of lines
  std::optional<Time> last_pose_;
};

}  // namespace rimod
