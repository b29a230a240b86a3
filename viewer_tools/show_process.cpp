#include "viewer_tools/show_process.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

#include "io/bus.h"
#include "io/detection_messages.h"
#include "io/files.h"
#include "io/process_options.h"
#include "viewer_tools/detection_table.h"
#include "viewer_tools/recorded_scans.h"

namespace rimod {
namespace {

constexpr std::size_t kMaxProcesses = 64;  // whose times are kept
constexpr std::size_t kMaxTold = 64;       // different complaints
constexpr char kMatcher[] = "rimod-matcher";

ScanReport MakeReport(const std::string& name, const StampedDetections& detections) {
  return {name, detections.num_models, detections.T_local_sensor.translation(),
          detections.detections};
}

void Print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace

ShowProcess::ShowProcess(lcm::LCM* lcm, const Channels& channels, const ShowLimits& limits)
    : limits_(limits), last_scan_(std::chrono::steady_clock::now()) {
  constexpr int kQueueCapacity = 30;
  SubscriptionObserver observer;
  observer.on_received = [](const std::string&) {};
  observer.on_rejected = [this](const std::string& channel, const std::string& cause) {
    const bool is_new = told_.size() < kMaxTold && told_.insert(channel + ": " + cause).second;
    if (is_new) spdlog::warn("{}: message left out: {}", channel, cause);
  };
  subscriptions_.push_back(SubscribeTo<detections_t>(
      lcm, channels.detections, kQueueCapacity, observer,
      [this](const detections_t& message) { return OnDetections(message); }));
  subscriptions_.push_back(
      SubscribeTo<status_t>(lcm, channels.status, kQueueCapacity, observer,
                            [this](const status_t& message) { return OnStatus(message); }));
}

bool ShowProcess::GaveUp() const {
  return limits_.patience && std::chrono::steady_clock::now() - last_scan_ > *limits_.patience;
}

bool ShowProcess::Done() const {
  const auto was_heard = [this](const std::string& process) {
    return process_times_.count(process) > 0;
  };
  const bool all_heard = !limits_.awaited.empty() &&
                         std::all_of(limits_.awaited.begin(), limits_.awaited.end(), was_heard);
  return all_heard || (limits_.max_scans > 0 && num_scans_ >= limits_.max_scans) || GaveUp();
}

std::string ShowProcess::OnDetections(const detections_t& message) {
  const DetectionsFromMessage converted = FromMessage(message);
  if (!converted.detections) return converted.error;
  std::vector<ProcessTimes> times;
  for (const auto& [process, stage_times] : process_times_)
    if (process != kMatcher) times.push_back({process, stage_times});
  times.push_back({kMatcher, converted.detections->stage_times});
  Print(
      FormatDetections(MakeReport("scan " + std::to_string(message.utime), *converted.detections)) +
      FormatStageTimes(times) + "\n");
  ++num_scans_;
  last_scan_ = std::chrono::steady_clock::now();
  return "";
}

std::string ShowProcess::OnStatus(const status_t& message) {
  if (process_times_.size() >= kMaxProcesses && process_times_.count(message.process) == 0)
    return "too many different processes";
  StageTimes times;
  for (const stage_time_t& stage : message.stage_times) times.emplace_back(stage.stage, stage.ms);
  process_times_[message.process] = std::move(times);
  return "";
}

int ShowLive(const std::string& lcm_url, const Channels& channels, const ShowLimits& limits) {
  const StopOnSignal signal;
  const std::unique_ptr<lcm::LCM> lcm = OpenLcm(lcm_url);
  if (!lcm) return 1;
  ShowProcess process(lcm.get(), channels, limits);
  std::atomic<bool> stop{false};
  const auto on_idle = [&] { stop = signal.stop() || process.Done(); };
  if (!RunBus(lcm.get(), stop, on_idle)) return 1;
  if (!process.GaveUp()) return 0;
  spdlog::error("gave up: no scan on {}, or not every process on {}", channels.detections,
                channels.status);
  return 1;
}

int ShowLog(const std::string& path, const Channels& channels) {
  StageTimes
      last_times;  // of the matcher, more telling than its status' medians when there is one scan
  const RecordedScansReport report =
      ReadRecordedScans(path, channels, WantedImages::kNone, [&](const RecordedScan& scan) {
        const std::string name = FileStem(path) + ", scan " + std::to_string(scan.detections.utime);
        Print(FormatDetections(MakeReport(name, scan.detections)) + "\n");
        last_times = scan.detections.stage_times;
      });
  std::vector<ProcessTimes> times;
  for (const ProcessTimes& process : report.process_times)
    if (process.process != kMatcher || report.num_scans != 1) times.push_back(process);
  if (report.num_scans == 1) times.push_back({kMatcher, last_times});
  Print(FormatStageTimes(times));
  for (const std::string& error : report.errors) spdlog::error("{}", error);
  if (report.num_scans == 0 && report.errors.empty())
    spdlog::error("{}: nothing on {}", path, channels.detections);
  return report.errors.empty() && report.num_scans > 0 ? 0 : 1;
}

}  // namespace rimod
