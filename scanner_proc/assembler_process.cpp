#include "scanner_proc/assembler_process.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "io/laser_messages.h"
#include "io/partial_messages.h"
#include "io/scan_messages.h"
#include "io/status_counters.h"

namespace rimod {
namespace {

// Every line counts: a minute of a fast laser may wait.
constexpr int kQueueCapacity = 10000;

StampedScan ToStampedScan(const Sweep& sweep) {
  return {sweep.begin.count(), sweep.end.count(), sweep.num_lines, sweep.num_missing_lines,
          sweep.scan};
}

}  // namespace

AssemblerProcess::AssemblerProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                                   const Configuration& configuration, bool tell_growth)
    : scan_channel_(channels.scan),
      partial_scan_channel_(channels.partial_scan),
      tell_growth_(tell_growth),
      growth_period_(configuration.pipeline.early.period),
      idle_time_(configuration.bus.idle_time),
      quiet_time_(configuration.bus.quiet_time),
      assembler_(configuration.pipeline.sweep),
      last_input_(Clock::now()),
      status_(out, channels.status, "rimod-assembler"),
      publisher_(out, configuration.bus) {
  subscriptions_.push_back(SubscribeTo<bot_core::planar_lidar_t>(
      in, channels.laser, kQueueCapacity, status_.MakeObserver(),
      [this](const bot_core::planar_lidar_t& message) { return OnLine(message); }));
  subscriptions_.push_back(SubscribeTo<bot_core::rigid_transform_t>(
      in, channels.laser_to_local, kQueueCapacity, status_.MakeObserver(),
      [this](const bot_core::rigid_transform_t& message) { return OnPose(message); }));
}

std::string AssemblerProcess::OnLine(const bot_core::planar_lidar_t& message) {
  LaserLineFromMessage line = FromMessage(message);
  if (!line.line) return line.error;
  NoteInput();
  const std::vector<Sweep> sweeps = assembler_.AddLine(std::move(*line.line));
  assembly_time_ += Clock::now() - last_input_;
  PublishEnded(sweeps);
  PublishGrowth();
  return "";
}

std::string AssemblerProcess::OnPose(const bot_core::rigid_transform_t& message) {
  const TimedPoseFromMessage pose = FromMessage(message);
  if (!pose.pose) return pose.error;
  NoteInput();
  const std::vector<Sweep> sweeps = assembler_.AddPose(*pose.pose);
  assembly_time_ += Clock::now() - last_input_;
  PublishEnded(sweeps);
  PublishGrowth();
  return "";
}

void AssemblerProcess::NoteInput() {
  const auto now = Clock::now();
  longest_gap_ =
      assembler_.collecting() ? std::max(longest_gap_, now - last_input_) : Clock::duration{0};
  last_input_ = now;
  looked_ = false;
}

// A machine that delivers lines late may pause in the midst of a sweep: a gap much longer than any
// before is needed.
bool AssemblerProcess::LinesStopped() const {
  constexpr int kLongerThanAnyGap = 3;
  const auto quiet = Clock::now() - last_input_;
  return quiet > quiet_time_ && quiet > kLongerThanAnyGap * longest_gap_;
}

void AssemblerProcess::OnIdle() {
  if (assembler_.collecting() && Clock::now() - last_input_ > idle_time_) {
    const auto begin = Clock::now();
    const std::vector<Sweep> sweeps = assembler_.Finish();
    assembly_time_ += Clock::now() - begin;
    PublishEnded(sweeps);
  } else if (assembler_.collecting() && !looked_ && LinesStopped()) {
    looked_ = true;
    PublishUnended();
  }
  ReportCounters();
  status_.PublishIfDue();
}

void AssemblerProcess::PublishEnded(const std::vector<Sweep>& sweeps) {
  for (const Sweep& sweep : sweeps) {
    if (sweep.complete()) {
      PublishScan(sweep);
    } else {
      status_.CountDropped("incomplete sweeps");
      status_.ReportError("incomplete: " + sweep.incomplete_reason,
                          "sweep of " + std::to_string(sweep.num_lines) +
                              " lines left out: " + sweep.incomplete_reason);
    }
    sent_.reset();
  }
  if (sweeps.empty()) return;
  assembly_time_ = Clock::duration{0};
  longest_gap_ = Clock::duration{0};
}

// The scan that it would be if nothing more came.
void AssemblerProcess::PublishUnended() {
  SweepAssembler ended = assembler_;
  for (const Sweep& sweep : ended.Finish())
    if (sweep.complete()) PublishScan(sweep);
}

void AssemblerProcess::PublishScan(const Sweep& sweep) {
  if (sent_ && sent_->begin == sweep.begin && sent_->end == sweep.end &&
      sent_->num_lines == sweep.num_lines)
    return;
  sent_ = SentScan{sweep.begin, sweep.end, sweep.num_lines};
  publisher_.PublishAll(scan_channel_, ToSections(ToStampedScan(sweep)));
  status_.CountOut();
  const std::chrono::duration<double, std::milli> elapsed = assembly_time_;
  status_.AddStageTimes({{"assembly", elapsed.count()}});
  spdlog::info("scan {}: {} lines, {} points", sweep.begin.count(), sweep.num_lines,
               sweep.scan.points.size());
}

void AssemblerProcess::PublishGrowth() {
  if (!tell_growth_) return;
  const std::optional<SweepGrowth> growth = assembler_.TakeGrowth(growth_period_);
  if (growth) publisher_.PublishAll(partial_scan_channel_, ToPartialSections(*growth));
}

void AssemblerProcess::ReportCounters() {
  const SweepCounters counters = assembler_.counters();
  status_.SetCounter("lines", counters.lines);
  status_.SetCounter("poses", counters.poses);
  status_.SetCounter("bad lines", counters.bad_lines);
  status_.SetCounter("bad poses", counters.bad_poses);
  status_.SetCounter("unordered lines", counters.unordered_lines);
  status_.SetCounter("unordered poses", counters.unordered_poses);
  status_.SetCounter("lines without pose", counters.lines_without_pose);
  status_.SetCounter("idle lines", counters.idle_lines);
  status_.SetCounter("bad ranges", counters.bad_ranges);
  status_.SetCounter("near ranges", counters.near_ranges);
  status_.SetCounter("missing lines", counters.missing_lines);
  status_.SetCounter("clock jumps", counters.clock_jumps);
  status_.SetCounter("unsent messages", publisher_.num_failed());
  status_.SetGauge(kWaitingMessagesCounter, publisher_.num_waiting());
}

}  // namespace rimod
