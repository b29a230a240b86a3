#include "io/scan_source.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "io/channels.h"
#include "io/cloud_messages.h"
#include "io/event_log.h"
#include "io/files.h"
#include "io/laser_messages.h"
#include "io/message_codec.h"
#include "io/point_cloud_file.h"
#include "io/scan_messages.h"
#include "io/section_joiner.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

// Names a log's scans and hands them on. The first waits for a second, as its name depends on that.
class LogScans {
 public:
  LogScans(std::string log_name, const std::function<void(NamedScan)>& on_scan)
      : log_name_(std::move(log_name)), on_scan_(on_scan), begin_(Clock::now()) {}

  void Add(std::int64_t utime, std::int64_t utime_end, Scan scan) {
    const std::chrono::duration<double, std::milli> elapsed = Clock::now() - begin_;
    if (waiting_) HandOn(/*only=*/false);
    waiting_ = NamedScan{"", utime, utime_end, elapsed.count(), /*from_log=*/true, std::move(scan)};
    begin_ = Clock::now();
  }

  // Returns how many scans there were.
  int Finish() {
    if (waiting_) HandOn(/*only=*/num_handed_on_ == 0);
    return num_handed_on_;
  }

 private:
  void HandOn(bool only) {
    waiting_->name = only ? log_name_ : log_name_ + "#" + std::to_string(num_handed_on_);
    ++num_handed_on_;
    on_scan_(std::move(*waiting_));
    waiting_.reset();
  }

  std::string log_name_;
  const std::function<void(NamedScan)>& on_scan_;
  Clock::time_point begin_;  // of the work for the next scan
  std::optional<NamedScan> waiting_;
  int num_handed_on_ = 0;
};

// Counts messages that could not be used and remembers the first cause.
class Rejections {
 public:
  void Add(const std::string& channel, const std::string& cause) {
    if (count_++ == 0) first_ = channel + ": " + cause;
  }
  void Report(const std::string& path, ScanSourceReport* report) const {
    if (count_ == 0) return;
    report->warnings.push_back(path + ": " + std::to_string(count_) +
                               " messages could not be used, the first on " + first_);
  }

 private:
  std::int64_t count_ = 0;
  std::string first_;
};

// The channels of a log, up to where it is clear that it has all that a sweep needs.
std::set<std::string> ChannelsOf(const std::string& path, const Channels& channels) {
  constexpr std::size_t kMaxChannels = 1000;
  std::set<std::string> found;
  EventLogReader log(path);
  while (const std::optional<LogEvent> event = log.Next()) {
    if (found.size() < kMaxChannels) found.insert(event->channel);
    if (found.count(channels.laser) > 0 && found.count(channels.laser_to_local) > 0) break;
  }
  return found;
}

void AddSweeps(const std::string& path, std::vector<Sweep> sweeps, LogScans* scans,
               ScanSourceReport* report) {
  for (Sweep& sweep : sweeps) {
    if (sweep.complete()) {
      scans->Add(sweep.begin.count(), sweep.end.count(), std::move(sweep.scan));
    } else {
      report->warnings.push_back(path + ": left out a sweep of " + std::to_string(sweep.num_lines) +
                                 " lines: " + sweep.incomplete_reason);
    }
  }
}

// Tells what was left out, as far as a good log has none of it.
void ReportCounts(const std::string& path,
                  const std::vector<std::pair<const char*, std::int64_t>>& counts,
                  ScanSourceReport* report) {
  std::string text;
  for (const auto& [name, count] : counts) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + name;
  }
  if (!text.empty()) report->warnings.push_back(path + ": " + text);
}

void ReportCounters(const std::string& path, const SweepCounters& counters,
                    ScanSourceReport* report) {
  ReportCounts(path,
               {{"unusable lines", counters.bad_lines},
                {"unusable poses", counters.bad_poses},
                {"lines out of order", counters.unordered_lines},
                {"poses out of order", counters.unordered_poses},
                {"lines without pose", counters.lines_without_pose},
                {"missing lines", counters.missing_lines},
                {"unusable ranges", counters.bad_ranges},
                {"jumps of the clock", counters.clock_jumps}},
               report);
}

void ReportCounters(const std::string& path, const CloudCounters& counters,
                    ScanSourceReport* report) {
  ReportCounts(path,
               {{"clouds of no time", counters.bad_clouds},
                {"clouds out of order", counters.unordered_clouds},
                {"clouds without pose", counters.clouds_without_pose},
                {"unusable poses", counters.bad_poses},
                {"poses out of order", counters.unordered_poses}},
               report);
}

// What an event's message says; nothing where it cannot be used, which is counted. value: where the
// result of FromMessage(Message) has it.
template <typename Message, typename Result, typename Value>
std::optional<Value> ValueOf(const LogEvent& event, std::optional<Value> Result::*value,
                             Rejections* rejections) {
  const Decoded<Message> decoded = DecodeMessage<Message>(event.bytes.data(), event.bytes.size());
  Result result;
  if (decoded.message) result = FromMessage(*decoded.message);
  if (!(result.*value)) rejections->Add(event.channel, decoded.error + result.error);
  return std::move(result.*value);
}

std::optional<TimedPose> PoseOf(const LogEvent& event, Rejections* rejections) {
  return ValueOf<bot_core::rigid_transform_t>(event, &TimedPoseFromMessage::pose, rejections);
}

void AssembleLog(const std::string& path, const Channels& channels, const ScanSourceParams& params,
                 LogScans* scans, ScanSourceReport* report) {
  EventLogReader log(path);
  SweepAssembler assembler(params.sweep);
  Rejections rejections;
  while (const std::optional<LogEvent> event = log.Next()) {
    if (event->channel == channels.laser) {
      std::optional<LaserLine> line =
          ValueOf<bot_core::planar_lidar_t>(*event, &LaserLineFromMessage::line, &rejections);
      if (line) AddSweeps(path, assembler.AddLine(std::move(*line)), scans, report);
    } else if (event->channel == channels.laser_to_local) {
      const std::optional<TimedPose> pose = PoseOf(*event, &rejections);
      if (pose) AddSweeps(path, assembler.AddPose(*pose), scans, report);
    }
    if (!params.on_growth) continue;
    const std::optional<SweepGrowth> growth = assembler.TakeGrowth(params.growth_period);
    if (growth) params.on_growth(*growth);
  }
  AddSweeps(path, assembler.Finish(), scans, report);
  rejections.Report(path, report);
  ReportCounters(path, assembler.counters(), report);
  if (!log.error().empty()) report->errors.push_back(log.error());
}

// Places the point clouds of a log.
void PlaceClouds(const std::string& path, const ScanSourceParams& params, LogScans* scans,
                 ScanSourceReport* report) {
  const CloudChannels& channels = params.cloud_channels;
  EventLogReader log(path);
  CloudPlacer placer(params.cloud, !channels.poses.empty());
  Rejections rejections;
  const auto add = [scans](std::vector<PlacedCloud> clouds) {
    for (PlacedCloud& cloud : clouds) {
      scans->Add(cloud.time.count(), cloud.time.count(), std::move(cloud.scan));
    }
  };
  while (const std::optional<LogEvent> event = log.Next()) {
    if (event->channel == channels.clouds) {
      std::optional<SensorCloud> cloud =
          ValueOf<bot_core::pointcloud2_t>(*event, &SensorCloudFromMessage::cloud, &rejections);
      if (cloud) add(placer.AddCloud(std::move(*cloud)));
    } else if (event->channel == channels.poses) {
      const std::optional<TimedPose> pose = PoseOf(*event, &rejections);
      if (pose) add(placer.AddPose(*pose));
    }
  }
  rejections.Report(path, report);
  ReportCounters(path, placer.counters(), report);
  if (!log.error().empty()) report->errors.push_back(log.error());
}

// Joins the scans that a log holds ready-made.
void JoinLog(const std::string& path, const Channels& channels, LogScans* scans,
             ScanSourceReport* report) {
  EventLogReader log(path);
  SectionJoiner<scan_t> joiner;
  Clock::time_point now{};  // the log's clock, never backwards
  Rejections rejections;
  while (const std::optional<LogEvent> event = log.Next()) {
    if (event->channel != channels.scan) continue;
    constexpr std::int64_t kLatest = 4'000'000'000'000'000;  // us, in the year 2096
    const std::chrono::microseconds received(std::clamp<std::int64_t>(event->utime, 0, kLatest));
    now = std::max(now, Clock::time_point(received));
    auto decoded = DecodeMessage<scan_t>(event->bytes.data(), event->bytes.size());
    if (!decoded.message) {
      rejections.Add(event->channel, decoded.error);
      continue;
    }
    const std::optional<std::vector<scan_t>> sections =
        joiner.Add(std::move(*decoded.message), now);
    if (!sections) continue;
    JoinedScan joined = JoinScanSections(*sections);
    if (joined.scan) {
      scans->Add(joined.scan->utime, joined.scan->utime_end, std::move(joined.scan->scan));
    } else {
      rejections.Add(event->channel, joined.error);
    }
  }
  rejections.Report(path, report);
  const SectionCounters& counters = joiner.counters();
  const std::int64_t num_lost =
      counters.incomplete + counters.conflicting + static_cast<std::int64_t>(joiner.num_open());
  if (num_lost > 0) {
    report->warnings.push_back(path + ": left out " + std::to_string(num_lost) +
                               " scans with missing or differing sections");
  }
  if (!log.error().empty()) report->errors.push_back(log.error());
}

std::string ListOf(const std::set<std::string>& names) {
  constexpr std::size_t kMaxChars = 200;
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  if (text.size() > kMaxChars) text = text.substr(0, kMaxChars) + ", ..";
  return text.empty() ? "no whole event" : text;
}

ScanSourceReport ReadLog(const std::string& path, const ScanSourceParams& params,
                         const std::function<void(NamedScan)>& on_scan) {
  ScanSourceReport report;
  const Channels channels;
  LogScans scans(FileStem(path), on_scan);
  std::string cause = "holds no complete scan";
  if (!params.cloud_channels.clouds.empty()) {
    PlaceClouds(path, params, &scans, &report);
    cause = "holds no usable point cloud on " + params.cloud_channels.clouds;
  } else {
    const std::set<std::string> found = ChannelsOf(path, channels);
    const auto has = [&found](const std::string& channel) { return found.count(channel) > 0; };
    if (has(channels.laser) && has(channels.laser_to_local)) {
      AssembleLog(path, channels, params, &scans, &report);
    } else if (has(channels.scan)) {
      JoinLog(path, channels, &scans, &report);
    } else {
      cause = "has neither " + channels.laser + " with " + channels.laser_to_local + " nor " +
              channels.scan + ", but " + ListOf(found);
    }
  }
  report.num_scans = scans.Finish();
  if (report.num_scans == 0) report.errors.push_back(path + ": " + cause);
  return report;
}

}  // namespace

ScanSourceReport ReadScans(const std::string& path, const ScanSourceParams& params,
                           const std::function<void(NamedScan)>& on_scan) {
  if (IsEventLog(path)) return ReadLog(path, params, on_scan);
  ScanSourceReport report;
  PointCloudResult cloud = ReadPointCloud(path);
  if (!cloud.warning.empty()) report.warnings.push_back(cloud.warning);
  if (!cloud.scan) {
    report.errors.push_back(cloud.error);
    return report;
  }
  NamedScan scan;
  scan.name = FileStem(path);
  scan.scan = std::move(*cloud.scan);
  report.num_scans = 1;
  on_scan(std::move(scan));
  return report;
}

ScanSourceReport ReadScans(const std::string& path, const SweepParams& params,
                           const std::function<void(NamedScan)>& on_scan) {
  ScanSourceParams source;
  source.sweep = params;
  return ReadScans(path, source, on_scan);
}

}  // namespace rimod
