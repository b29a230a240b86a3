#include "scanner_proc/assembler_process.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "io/laser_messages.h"
#include "io/scan_messages.h"

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
                                   const Configuration& configuration)
    : scan_channel_(channels.scan),
      idle_time_(configuration.bus.idle_time),
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
  last_input_ = Clock::now();
  const std::vector<Sweep> sweeps = assembler_.AddLine(std::move(*line.line));
  assembly_time_ += Clock::now() - last_input_;
  Publish(sweeps);
  return "";
}

std::string AssemblerProcess::OnPose(const bot_core::rigid_transform_t& message) {
  const TimedPoseFromMessage pose = FromMessage(message);
  if (!pose.pose) return pose.error;
  last_input_ = Clock::now();
  const std::vector<Sweep> sweeps = assembler_.AddPose(*pose.pose);
  assembly_time_ += Clock::now() - last_input_;
  Publish(sweeps);
  return "";
}

void AssemblerProcess::OnIdle() {
  if (assembler_.collecting() && Clock::now() - last_input_ > idle_time_) {
    const auto begin = Clock::now();
    const std::vector<Sweep> sweeps = assembler_.Finish();
    assembly_time_ += Clock::now() - begin;
    Publish(sweeps);
  }
  ReportCounters();
  status_.PublishIfDue();
}

void AssemblerProcess::Publish(const std::vector<Sweep>& sweeps) {
  for (const Sweep& sweep : sweeps) {
    if (!sweep.complete()) {
      status_.CountDropped("incomplete sweeps");
      status_.ReportError("incomplete: " + sweep.incomplete_reason,
                          "sweep of " + std::to_string(sweep.num_lines) +
                              " lines left out: " + sweep.incomplete_reason);
      continue;
    }
    publisher_.PublishAll(scan_channel_, ToSections(ToStampedScan(sweep)));
    status_.CountOut();
    const std::chrono::duration<double, std::milli> elapsed = assembly_time_;
    status_.AddStageTimes({{"assembly", elapsed.count()}});
    spdlog::info("scan {}: {} lines, {} points", sweep.begin.count(), sweep.num_lines,
                 sweep.scan.points.size());
  }
  if (!sweeps.empty()) assembly_time_ = Clock::duration{0};
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
}

}  // namespace rimod
