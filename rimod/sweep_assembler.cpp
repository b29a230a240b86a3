#include "rimod/sweep_assembler.h"

#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace rimod {
namespace {

constexpr char kClockRanBackwards[] = "the clock ran backwards";
// True when of two earlier times of a stream's clock, before and after a jump, this one belongs to
// the time before.
bool BelongsBefore(Time time, Time before_jump, Time after_jump) {
  return std::abs((time - before_jump).count()) < std::abs((time - after_jump).count());
}

void Require(bool legal, const char* field, double value, const char* range) {
  if (legal) return;
  std::ostringstream text;
  text << "sweep parameter " << field << " is " << value << ", must be " << range;
  throw std::invalid_argument(text.str());
}

}  // namespace

void SweepParams::Validate() const {
  constexpr double kLongest = 1e6;  // s, m; keeps every product finite
  const auto positive = [](double value) { return value > 0.0 && value <= kLongest; };
  const auto not_negative = [](double value) { return value >= 0.0 && value <= kLongest; };
  Require(positive(line_duration), "line_duration", line_duration, "> 0 s");
  Require(beams_per_line >= 1, "beams_per_line", beams_per_line, ">= 1");
  Require(not_negative(min_range), "min_range", min_range, ">= 0 m");
  Require(max_range > min_range && max_range <= kLongest, "max_range", max_range, "> min_range");
  Require(positive(reversal_angle), "reversal_angle", reversal_angle, "> 0 rad");
  Require(positive(pause_duration), "pause_duration", pause_duration, "> 0 s");
  Require(not_negative(rest_rate), "rest_rate", rest_rate, ">= 0 rad/s");
  Require(positive(min_sweep_angle), "min_sweep_angle", min_sweep_angle, "> 0 rad");
  Require(max_missing_share >= 0.0 && max_missing_share <= 1.0, "max_missing_share",
          max_missing_share, "0 .. 1");
  Require(positive(max_pose_gap), "max_pose_gap", max_pose_gap, "> 0 s");
  Require(max_buffered_lines >= 1, "max_buffered_lines", max_buffered_lines, ">= 1");
  Require(max_buffered_poses >= 2, "max_buffered_poses", max_buffered_poses, ">= 2");
  Require(max_lines >= 1, "max_lines", max_lines, ">= 1");
}

SweepAssembler::SweepAssembler(const SweepParams& params)
    : params_((params.Validate(), params)), placer_(params), collector_(params) {}

SweepCounters SweepAssembler::counters() const {
  SweepCounters counters = counters_;
  collector_.AddCounters(&counters);
  return counters;
}

std::vector<Sweep> SweepAssembler::AddLine(LaserLine line) {
  std::vector<Sweep> ended;
  if (!IsUsableTime(line.time) || !IsUsableLine(line)) {
    ++counters_.bad_lines;
    return ended;
  }
  if (last_line_ && line.time <= *last_line_) {
    if (std::chrono::duration<double>(*last_line_ - line.time).count() < params_.pause_duration) {
      ++counters_.unordered_lines;
      return ended;
    }
    HandleLineClockJump(line.time, &ended);
  }
  last_line_ = line.time;
  waiting_.push_back(std::move(line));
  if (waiting_.size() > static_cast<std::size_t>(params_.max_buffered_lines)) {
    waiting_.pop_front();
    ++counters_.lines_without_pose;
  }
  PlaceWaiting(&ended);
  return ended;
}

std::vector<Sweep> SweepAssembler::AddPose(const TimedPose& pose) {
  std::vector<Sweep> ended;
  if (!IsUsablePose(pose)) {
    ++counters_.bad_poses;
    return ended;
  }
  if (last_pose_ && pose.time <= *last_pose_) {
    if (std::chrono::duration<double>(*last_pose_ - pose.time).count() < params_.pause_duration) {
      ++counters_.unordered_poses;
      return ended;
    }
    HandlePoseClockJump(pose.time, &ended);
  }
  last_pose_ = pose.time;
  ++counters_.poses;
  poses_.Add(pose);
  if (poses_.size() > static_cast<std::size_t>(params_.max_buffered_poses)) poses_.ForgetOldest();
  PlaceWaiting(&ended);
  return ended;
}

std::vector<Sweep> SweepAssembler::Finish() {
  std::vector<Sweep> ended;
  counters_.lines_without_pose += static_cast<std::int64_t>(waiting_.size());
  waiting_.clear();
  collector_.End("", &ended);
  poses_.Clear();
  last_line_.reset();
  last_pose_.reset();
  return ended;
}

void SweepAssembler::PlaceWaiting(std::vector<Sweep>* ended) {
  while (!waiting_.empty()) {
    const LaserLine& line = waiting_.front();
    const PoseTrack::Coverage coverage =
        poses_.Covers(line.time, placer_.Duration(line), params_.max_pose_gap * 1e6);
    if (coverage == PoseTrack::Coverage::kNotYet) break;
    if (coverage == PoseTrack::Coverage::kCovered) {
      collector_.Add(placer_.Place(line, poses_, &counters_), ended);
      ++counters_.lines;
    } else {
      ++counters_.lines_without_pose;
    }
    waiting_.pop_front();
  }
  // Lines to come are later than the last one.
  if (last_line_) poses_.ForgetBefore(waiting_.empty() ? *last_line_ : waiting_.front().time);
}

// The lines' clock went back. A single line with a time far ahead looks the same: then only what is
// ahead is dropped and the sweep goes on.
void SweepAssembler::HandleLineClockJump(Time to, std::vector<Sweep>* ended) {
  ++counters_.clock_jumps;
  const Time from = *last_line_;
  const std::optional<Time> placed = collector_.newest();
  if (placed && to <= *placed) {
    GiveUpLines(ended);
  } else {
    DropWaitingFrom(to);
  }
  // Poses of the time before the jump cannot place the lines after it.
  if (last_pose_ && BelongsBefore(*last_pose_, from, to)) {
    poses_.Clear();
    last_pose_.reset();
  }
}

void SweepAssembler::HandlePoseClockJump(Time to, std::vector<Sweep>* ended) {
  ++counters_.clock_jumps;
  const Time from = *last_pose_;
  poses_.ForgetFrom(to);
  if (last_line_ && BelongsBefore(*last_line_, from, to)) {
    GiveUpLines(ended);
    last_line_.reset();
  }
}

void SweepAssembler::GiveUpLines(std::vector<Sweep>* ended) {
  counters_.lines_without_pose += static_cast<std::int64_t>(waiting_.size());
  waiting_.clear();
  collector_.End(kClockRanBackwards, ended);
}

void SweepAssembler::DropWaitingFrom(Time time) {
  while (!waiting_.empty() && waiting_.back().time >= time) {
    waiting_.pop_back();
    ++counters_.lines_without_pose;
  }
}

}  // namespace rimod
