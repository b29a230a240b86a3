#include "rimod/sweep_collector.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace rimod {
namespace {

// 240 MB of points: a scan beyond that is not one of a tilting laser, whatever max_lines allows.
constexpr std::size_t kMaxPoints = 20000000;
// A mean of unit vectors shorter than this has no direction to speak of.
constexpr double kMinMeanForward = 0.05;
// Two lasers on one channel: their lines alternate, so that at least every second one follows the
// one before after half a line or less. One laser's lines come at line_duration; a late stamp
// brings the next line closer, but that of few.
constexpr double kCrowdedGap = 0.75;      // of line_duration
constexpr double kMaxCrowdedShare = 0.3;  // of a sweep's lines

double Seconds(Time duration) { return std::chrono::duration<double>(duration).count(); }

// angle plus the whole turns that bring it nearest to the reference.
double Unwrapped(double angle, double reference) {
  return reference + std::remainder(angle - reference, 2.0 * M_PI);
}

std::string Format(const char* format, double first, double second) {
  char text[200];
  std::snprintf(text, sizeof(text), format, first, second);
  return text;
}

double Degrees(double radians) { return radians * 180.0 / M_PI; }

}  // namespace

std::optional<Time> SweepCollector::newest() const {
  if (lines_.empty()) return std::nullopt;
  return lines_.back().begin;
}

void SweepCollector::AddCounters(SweepCounters* counters) const {
  counters->idle_lines += idle_lines_;
  counters->missing_lines += missing_lines_;
  counters->crowded_lines += crowded_lines_;
  counters->complete_sweeps += complete_sweeps_;
  counters->incomplete_sweeps += incomplete_sweeps_;
}

void SweepCollector::Add(const PlacedLine& line, std::vector<Sweep>* ended) {
  if (!lines_.empty() && Seconds(line.begin - lines_.back().begin) >= params_.pause_duration) {
    End("", ended);
  }
  Append(line);
  FollowTilt(lines_.size() - 1);
  if (HasReversed()) {
    EndAt(extreme_ + 1, "", ended);
  } else if (IsResting()) {
    End("", ended);
  } else if (lines_.size() > static_cast<std::size_t>(params_.max_lines)) {
    End(Format("longer than %.0f lines", params_.max_lines, 0.0), ended);
  } else if (points_.size() + no_return_directions_.size() > kMaxPoints) {
    End(Format("longer than %.0f readings", static_cast<double>(kMaxPoints), 0.0), ended);
  }
}

void SweepCollector::End(const std::string& incomplete_reason, std::vector<Sweep>* ended) {
  EndAt(lines_.size(), incomplete_reason, ended);
}

void SweepCollector::Append(const PlacedLine& placed) {
  Line line;
  line.begin = placed.begin;
  line.end = placed.end;
  line.tilt_begin =
      lines_.empty() ? placed.tilt_begin : Unwrapped(placed.tilt_begin, lines_.back().tilt_end);
  line.tilt_end = Unwrapped(placed.tilt_end, line.tilt_begin);
  line.missing_before = LinesMissingBefore(line);
  line.is_crowded = IsCrowded(line);
  line.first_point = points_.size();
  line.first_no_return = no_return_directions_.size();
  line.position = placed.position;
  line.forward = placed.forward;
  missing_lines_ += line.missing_before;
  crowded_lines_ += line.is_crowded ? 1 : 0;
  lines_.push_back(line);
  points_.insert(points_.end(), placed.points.begin(), placed.points.end());
  no_return_directions_.insert(no_return_directions_.end(), placed.no_return_directions.begin(),
                               placed.no_return_directions.end());
}

int SweepCollector::LinesMissingBefore(const Line& line) const {
  if (lines_.empty()) return 0;
  constexpr double kMost = 1e6;  // keeps the number an int when line_duration is absurdly small
  const double periods = Seconds(line.begin - lines_.back().begin) / params_.line_duration;
  return std::max(0, static_cast<int>(std::lround(std::min(periods, kMost))) - 1);
}

bool SweepCollector::IsCrowded(const Line& line) const {
  return !lines_.empty() &&
         Seconds(line.begin - lines_.back().begin) < kCrowdedGap * params_.line_duration;
}

void SweepCollector::FollowTilt(std::size_t index) {
  const Line& line = lines_[index];
  const double turned = line.tilt_end - lines_.front().tilt_begin;
  if (direction_ == 0 && std::abs(turned) >= params_.reversal_angle) {
    direction_ = turned > 0.0 ? 1 : -1;
    extreme_ = index;
  }
  if (direction_ * (line.tilt_end - lines_[extreme_].tilt_end) > 0.0) extreme_ = index;
  ends_.Follow(direction_, line.tilt_begin, line.tilt_end, index);
  const double rest_band = params_.rest_rate * params_.pause_duration;
  if (std::abs(line.tilt_end - lines_[rest_anchor_].tilt_end) > rest_band) rest_anchor_ = index;
}

bool SweepCollector::HasReversed() const {
  if (direction_ == 0) return false;
  const double returned = direction_ * (lines_[extreme_].tilt_end - lines_.back().tilt_end);
  return returned >= params_.reversal_angle;
}

bool SweepCollector::IsResting() const {
  const double duration = Seconds(lines_.back().begin - lines_[rest_anchor_].begin);
  return duration >= params_.pause_duration;
}

bool SweepCollector::LineRests(const Line& line) const {
  return std::abs(line.tilt_end - line.tilt_begin) <
         params_.rest_rate * Seconds(line.end - line.begin);
}

void SweepCollector::EndAt(std::size_t num_lines, const std::string& incomplete_reason,
                           std::vector<Sweep>* ended) {
  std::size_t first = 0;
  std::size_t last = num_lines;  // behind the last one
  while (first < last && LineRests(lines_[first])) ++first;
  while (last > first && LineRests(lines_[last - 1])) --last;
  if (direction_ == 0) last = first;  // never turned to speak of
  idle_lines_ += static_cast<std::int64_t>(num_lines - (last - first));
  if (last > first) {
    const double tilt_end = lines_[last - 1].tilt_end;
    ended->push_back(TakeSweep(first, last, incomplete_reason));
    if (ended->back().complete()) ends_.Learn(direction_, tilt_end, last - 1);
    ++(ended->back().complete() ? complete_sweeps_ : incomplete_sweeps_);
  }
  DropLines(num_lines);
}

std::optional<SweepGrowth> SweepCollector::TakeGrowth(double min_duration) {
  // Lines behind the extreme may belong to the next sweep, or to none.
  if (direction_ == 0 || num_grown_ > extreme_) return std::nullopt;
  std::size_t sweep_first = 0;
  while (sweep_first < extreme_ && LineRests(lines_[sweep_first])) ++sweep_first;
  const std::size_t first = std::max(num_grown_, sweep_first);
  std::size_t last = extreme_ + 1;
  while (last > first && LineRests(lines_[last - 1])) --last;  // they may be its idle end
  if (last == first || Seconds(lines_[last - 1].end - lines_[first].begin) < min_duration)
    return std::nullopt;
  SweepGrowth growth;
  growth.sweep_begin = lines_[sweep_first].begin;
  growth.step = growth_step_++;
  growth.begin = lines_[first].begin;
  growth.end = lines_[last - 1].end;
  growth.num_lines = static_cast<int>(last - first);
  growth.scan = CopyScan(first, last);
  growth.scan.T_local_sensor = SensorPose(sweep_first, last);
  num_grown_ = last;
  return growth;
}

Sweep SweepCollector::TakeSweep(std::size_t first, std::size_t last, const std::string& reason) {
  Sweep sweep;
  sweep.begin = lines_[first].begin;
  sweep.end = lines_[last - 1].end;
  sweep.num_lines = static_cast<int>(last - first);
  for (std::size_t i = first + 1; i < last; ++i)
    sweep.num_missing_lines += lines_[i].missing_before;
  const double share =
      sweep.num_missing_lines / static_cast<double>(sweep.num_missing_lines + sweep.num_lines);
  const auto num_crowded = std::count_if(lines_.begin() + first, lines_.begin() + last,
                                         [](const Line& line) { return line.is_crowded; });
  sweep.turned_angle = lines_[std::min(extreme_, last - 1)].tilt_end - lines_[first].tilt_begin;
  if (!reason.empty()) {
    sweep.incomplete_reason = reason;
  } else if (std::abs(sweep.turned_angle) < params_.min_sweep_angle) {
    sweep.incomplete_reason =
        Format("turned only %.1f degrees of at least %.1f", Degrees(std::abs(sweep.turned_angle)),
               Degrees(params_.min_sweep_angle));
  } else if (share > params_.max_missing_share) {
    sweep.incomplete_reason = Format("%.0f of %.0f lines are missing", sweep.num_missing_lines,
                                     sweep.num_lines + sweep.num_missing_lines);
  } else if (static_cast<double>(num_crowded) > kMaxCrowdedShare * sweep.num_lines) {
    sweep.incomplete_reason = Format(
        "%.0f of %.0f lines came sooner than one laser sends them: two on one channel, or a "
        "wrong line_duration",
        static_cast<double>(num_crowded), sweep.num_lines);
  } else {
    sweep.rest = RestOf(first, last);
    sweep.scan = TakeScan(first, last);
  }
  return sweep;
}

// Growths begin with the sweep's first line.
std::optional<SweepGrowth> SweepCollector::RestOf(std::size_t first, std::size_t last) const {
  if (growth_step_ == 0 || num_grown_ > last) return std::nullopt;
  SweepGrowth rest;
  rest.sweep_begin = lines_[first].begin;
  rest.step = growth_step_;
  rest.begin = lines_[std::min(num_grown_, last - 1)].begin;
  rest.end = lines_[last - 1].end;
  rest.num_lines = static_cast<int>(last - num_grown_);
  if (num_grown_ < last) rest.scan = CopyScan(num_grown_, last);
  rest.scan.T_local_sensor = SensorPose(first, last);
  return rest;
}

Scan SweepCollector::TakeScan(std::size_t first, std::size_t last) {
  if (first > 0 || last < lines_.size()) return CopyScan(first, last);
  Scan scan;
  scan.T_local_sensor = SensorPose(first, last);
  scan.points = std::move(points_);
  scan.no_return_directions = std::move(no_return_directions_);
  return scan;
}

Scan SweepCollector::CopyScan(std::size_t first, std::size_t last) const {
  Scan scan;
  scan.T_local_sensor = SensorPose(first, last);
  const auto end_of = [&](std::size_t Line::*start, std::size_t all) {
    return last < lines_.size() ? lines_[last].*start : all;
  };
  scan.points.assign(points_.begin() + lines_[first].first_point,
                     points_.begin() + end_of(&Line::first_point, points_.size()));
  scan.no_return_directions.assign(
      no_return_directions_.begin() + lines_[first].first_no_return,
      no_return_directions_.begin() + end_of(&Line::first_no_return, no_return_directions_.size()));
  return scan;
}

Eigen::Isometry3d SweepCollector::SensorPose(std::size_t first, std::size_t last) const {
  // Means relative to the first line, so that a sensor at rest keeps its position exactly.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  Eigen::Vector3d forward = Eigen::Vector3d::Zero();
  for (std::size_t i = first; i < last; ++i) {
    offset += lines_[i].position - lines_[first].position;
    forward += lines_[i].forward;
  }
  const double num_lines = static_cast<double>(last - first);
  // A laser that turned all the way round has no mean direction: that of the middle line then.
  const bool ambiguous = forward.head<2>().norm() < kMinMeanForward * num_lines;
  if (ambiguous) forward = lines_[first + (last - first) / 2].forward;
  Eigen::Isometry3d T_local_forward = Eigen::Isometry3d::Identity();
  T_local_forward.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), forward).toRotationMatrix();
  T_local_forward.translation() = lines_[first].position + offset / num_lines;
  return LevelPose(T_local_forward);
}

void SweepCollector::DropLines(std::size_t num_lines) {
  if (num_lines == lines_.size()) {
    lines_.clear();
    points_.clear();
    no_return_directions_.clear();
  } else {
    const std::size_t num_points = lines_[num_lines].first_point;
    const std::size_t num_no_returns = lines_[num_lines].first_no_return;
    points_.erase(points_.begin(), points_.begin() + num_points);
    no_return_directions_.erase(no_return_directions_.begin(),
                                no_return_directions_.begin() + num_no_returns);
    lines_.erase(lines_.begin(), lines_.begin() + num_lines);
    for (Line& line : lines_) {
      line.first_point -= num_points;
      line.first_no_return -= num_no_returns;
    }
  }
  direction_ = 0;
  extreme_ = 0;
  rest_anchor_ = 0;
  num_grown_ = 0;
  growth_step_ = 0;
  ends_.Begin();
  for (std::size_t i = 0; i < lines_.size(); ++i) FollowTilt(i);
}

}  // namespace rimod
