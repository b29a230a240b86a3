#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rimod/known_ends.h"
#include "rimod/line_placer.h"
#include "rimod/sweep.h"

namespace rimod {

// Cuts the stream of placed lines into sweeps of the tilt.
//
// A sweep ends where the tilt turned back (its lines since then begin the next sweep), where the
// tilt rests, where lines pause, or where it is told to. Lines before the tilt moves and after it
// has stopped are idle: they belong to no sweep.
class SweepCollector {
 public:
  explicit SweepCollector(const SweepParams& params) : params_(params) {}

  // line must begin later than the one before. Appends the sweeps that it ended to ended.
  void Add(const PlacedLine& line, std::vector<Sweep>* ended);
  // Ends the sweep at hand. A reason makes it incomplete; an empty one leaves that to its contents.
  void End(const std::string& incomplete_reason, std::vector<Sweep>* ended);

  // What the sweep at hand has grown by since the last call, when that lasts min_duration (s) or
  // longer. All growths of a sweep, one after the other, are its beginning, or all of it. Changes
  // nothing of the sweep itself.
  std::optional<SweepGrowth> TakeGrowth(double min_duration);

  bool empty() const { return lines_.empty(); }
  // True when the newest line is the first one of its sweep to reach the tilt at which the last
  // sweeps of its direction ended.
  bool reached_known_end() const { return !lines_.empty() && ends_.ReachedWith(lines_.size() - 1); }
  // Beginning of the newest line, nothing when there is none in the sweep at hand.
  std::optional<Time> newest() const;

  // Counts idle_lines, missing_lines and sweeps into these counters.
  void AddCounters(SweepCounters* counters) const;

 private:
  struct Line {
    Time begin{0}, end{0};
    double tilt_begin = 0.0, tilt_end = 0.0;  // rad, continuous: not wrapped at pi
    int missing_before = 0;                   // lines lost between the line before and this one
    bool is_crowded = false;                  // too soon after the line before
    std::size_t first_point = 0, first_no_return = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d forward = Eigen::Vector3d::Zero();
  };

  void Append(const PlacedLine& line);
  int LinesMissingBefore(const Line& line) const;
  bool IsCrowded(const Line& line) const;
  void FollowTilt(std::size_t index);
  bool HasReversed() const;
  bool IsResting() const;
  bool LineRests(const Line& line) const;
  void EndAt(std::size_t num_lines, const std::string& incomplete_reason,
             std::vector<Sweep>* ended);
  // Of the lines [first, last); may leave the lists of points empty.
  Sweep TakeSweep(std::size_t first, std::size_t last, const std::string& reason);
  std::optional<SweepGrowth> RestOf(std::size_t first, std::size_t last) const;
  Scan TakeScan(std::size_t first, std::size_t last);
  Scan CopyScan(std::size_t first, std::size_t last) const;
  Eigen::Isometry3d SensorPose(std::size_t first, std::size_t last) const;
  void DropLines(std::size_t num_lines);

  SweepParams params_;
  std::vector<Line> lines_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<Eigen::Vector3f> no_return_directions_;

  int direction_ = 0;            // of the tilt in this sweep: -1, 0 = not known yet, +1
  std::size_t extreme_ = 0;      // line that reached farthest in this direction
  std::size_t rest_anchor_ = 0;  // line since which the tilt has stayed where it was

  std::size_t num_grown_ = 0;  // lines, from the first, that growths have told
  int growth_step_ = 0;        // of the next growth

  KnownEnds ends_;

  std::int64_t idle_lines_ = 0;
  std::int64_t missing_lines_ = 0;
  std::int64_t crowded_lines_ = 0;
  std::int64_t complete_sweeps_ = 0;
  std::int64_t incomplete_sweeps_ = 0;
};

}  // namespace rimod
