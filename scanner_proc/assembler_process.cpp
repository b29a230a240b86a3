#include "scanner_proc/assembler_process.h"

#include <spdlog/spdlog.h>

#include <limits>
#include <utility>

#include "io/laser_messages.h"
#include "io/partial_messages.h"
#include "io/scan_messages.h"
#include "io/status_counters.h"

namespace rimod {
namespace {

// Every line counts: a minute of a fast laser may wait.
constexpr int kQueueCapacity = 10000;

// Of a sweep, s: what is sent at once, about a section. What is left at the sweep's end is less.
constexpr double kAheadPeriod = 0.25;

StampedScan ToStampedScan(const Sweep& sweep) {
  return {sweep.begin.count(), sweep.end.count(), sweep.num_lines, sweep.num_missing_lines,
          sweep.scan};
}

double GrowthPeriod(const Configuration& configuration, bool tell_growth) {
  if (tell_growth) return configuration.pipeline.early.period;
  return configuration.bus.scan_ahead ? kAheadPeriod : std::numeric_limits<double>::infinity();
}

}  // namespace

AssemblerProcess::AssemblerProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                                   const Configuration& configuration, bool tell_growth,
                                   const Tempo& tempo)
    : tempo_(tempo),
      scan_channel_(channels.scan),
      scan_ahead_channel_(channels.scan_ahead),
      scan_end_channel_(channels.scan_end),
      scan_ahead_(configuration.bus.scan_ahead),
      growth_channel_(tell_growth ? channels.partial_scan : channels.scan_ahead),
      growth_period_(GrowthPeriod(configuration, tell_growth)),
      idle_time_(configuration.bus.idle_time),
      assembler_(configuration.pipeline.sweep),
      last_input_(tempo.Now()),
      silence_(std::chrono::duration_cast<Clock::duration>(
                   std::chrono::duration<double>(configuration.bus.quiet_time)),
               last_input_),
      status_(out, channels.status, "rimod-assembler", tempo),
      senders_(in, channels.status, {channels.scan}, &status_),
      publisher_(out, configuration.bus, tempo) {
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
  silence_.OnLine(tempo_.Now(), !assembler_.collecting());
  Take([&] { return assembler_.AddLine(std::move(*line.line)); });
  return "";
}

std::string AssemblerProcess::OnPose(const bot_core::rigid_transform_t& message) {
  const TimedPoseFromMessage pose = FromMessage(message);
  if (!pose.pose) return pose.error;
  Take([&] { return assembler_.AddPose(*pose.pose); });
  return "";
}

template <typename Input>
void AssemblerProcess::Take(Input input) {
  last_input_ = tempo_.Now();
  silence_.OnInput(last_input_);
  const auto begin = Clock::now();
  const std::vector<Sweep> sweeps = input();
  assembly_time_ += Clock::now() - begin;
  PublishEnded(sweeps);
  PublishGrowth(growth_channel_, growth_period_);
  if (known_end_told_ || !assembler_.reached_known_end()) return;
  known_end_told_ = true;
  PublishUnended();
}

void AssemblerProcess::OnIdle() {
  const auto now = tempo_.Now();
  silence_.Look(now);
  if (assembler_.collecting() && now - last_input_ > idle_time_) {
    const auto begin = Clock::now();
    const std::vector<Sweep> sweeps = assembler_.Finish();
    assembly_time_ += Clock::now() - begin;
    PublishEnded(sweeps);
  } else if (assembler_.collecting() && assembler_.counters().lines != num_lines_seen_ &&
             silence_.LinesStopped(assembler_.has_waiting_lines())) {
    PublishUnended();
  }
  ReportCounters();
  senders_.Report(tempo_.Now());
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
  known_end_told_ = false;
}

// The scan that it would be if nothing more came.
void AssemblerProcess::PublishUnended() {
  num_lines_seen_ = assembler_.counters().lines;
  if (scan_ahead_) PublishGrowth(scan_ahead_channel_, 0.0);
  SweepAssembler ended = assembler_;
  for (const Sweep& sweep : ended.Finish())
    if (sweep.complete()) PublishScan(sweep);
}

void AssemblerProcess::PublishScan(const Sweep& sweep) {
  if (sent_ && sent_->begin == sweep.begin && sent_->end == sweep.end &&
      sent_->num_lines == sweep.num_lines)
    return;
  sent_ = SentScan{sweep.begin, sweep.end, sweep.num_lines};
  if (PublishAhead(sweep)) {
    publisher_.PublishAllSlowly(scan_channel_, ToSections(ToStampedScan(sweep)));
  } else {
    publisher_.PublishAll(scan_channel_, ToSections(ToStampedScan(sweep)));
  }
  status_.CountOut();
  const std::chrono::duration<double, std::milli> elapsed = assembly_time_;
  const StageTimes times = {{"assembly", elapsed.count()}};
  status_.AddStageTimes(times);
  tempo_.TellStageTimes(sweep.begin.count(), times);
  spdlog::info("scan {}: {} lines, {} points", sweep.begin.count(), sweep.num_lines,
               sweep.scan.points.size());
}

// What growth has not told yet of the scan, and its end. False where there is no such growth.
bool AssemblerProcess::PublishAhead(const Sweep& sweep) {
  if (!scan_ahead_ || !sweep.rest) return false;
  if (sweep.rest->num_lines > 0)
    publisher_.PublishAll(scan_ahead_channel_, ToPartialSections(*sweep.rest));
  publisher_.Publish(scan_end_channel_, ToScanEnd(sweep));
  return true;
}

void AssemblerProcess::PublishGrowth(const std::string& channel, double min_duration) {
  const std::optional<SweepGrowth> growth = assembler_.TakeGrowth(min_duration);
  if (growth) publisher_.PublishAll(channel, ToPartialSections(*growth));
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
  status_.SetCounter("lines too soon", counters.crowded_lines);
  status_.SetCounter("clock jumps", counters.clock_jumps);
  status_.SetCounter("unsent messages", publisher_.num_failed());
  status_.SetGauge(kWaitingMessagesCounter, publisher_.num_waiting());
}

}  // namespace rimod
