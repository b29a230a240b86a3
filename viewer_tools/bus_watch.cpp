#include "viewer_tools/bus_watch.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/pointcloud2_t.hpp"
#include "bot_core/rigid_transform_t.hpp"
#include "io/message_codec.h"
#include "io/status_counters.h"
#include "rimod/detections_t.hpp"
#include "rimod/early_detections_t.hpp"
#include "rimod/feature_set_t.hpp"
#include "rimod/object_model_t.hpp"
#include "rimod/partial_feature_set_t.hpp"
#include "rimod/partial_range_image_t.hpp"
#include "rimod/partial_scan_t.hpp"
#include "rimod/pose_hypotheses_t.hpp"
#include "rimod/range_image_t.hpp"
#include "rimod/scan_end_t.hpp"
#include "rimod/scan_t.hpp"
#include "rimod/shard_candidates_t.hpp"
#include "rimod/shard_scan_t.hpp"
#include "rimod/shard_t.hpp"
#include "rimod/shard_turn_t.hpp"

namespace rimod {
namespace {

constexpr std::size_t kMaxProcesses = 64;
constexpr std::size_t kMaxCauses = 64;
constexpr double kLately = 10.0;             // s
constexpr std::size_t kLatelyStatuses = 11;  // one a second: as long
constexpr std::size_t kLatelyScans = 100;
constexpr std::size_t kAllScans = 1000000;

// The places of the channels in the list.
enum : std::size_t {
  kLaser,
  kLaserToLocal,
  kScan,
  kRangeImage,
  kFeatures,
  kHypotheses,
  kDetections,
  kStatus
};

std::optional<StageOutput> OutputOn(std::size_t channel) {
  switch (channel) {
    case kScan:
      return StageOutput::kScan;
    case kRangeImage:
      return StageOutput::kRangeImage;
    case kFeatures:
      return StageOutput::kFeatures;
    case kHypotheses:
      return StageOutput::kHypotheses;
    case kDetections:
      return StageOutput::kDetections;
    default:
      return std::nullopt;
  }
}

template <typename Message>
ArrivedSection SectionFrom(const Message& message) {
  return {StageOutput::kScan, message.utime, 0, message.section, message.num_sections};
}
template <>
ArrivedSection SectionFrom(const scan_t& message) {
  return {StageOutput::kScan, message.utime, message.utime_end, message.section,
          message.num_sections};
}
template <>
ArrivedSection SectionFrom(const pose_hypotheses_t& message) {
  return {StageOutput::kHypotheses, message.utime, 0, 0, 1};
}
template <>
ArrivedSection SectionFrom(const detections_t& message) {
  return {StageOutput::kDetections, message.utime, 0, 0, 1};
}

// Whether nothing follows of what the message is a part of.
template <typename Message>
bool IsLastSection(const Message& /*message*/) {
  return true;
}
bool IsLast(int section, int num_sections) { return section == num_sections - 1; }
template <>
bool IsLastSection(const object_model_t& message) {
  return IsLast(message.section, message.num_sections);
}
template <>
bool IsLastSection(const partial_scan_t& message) {
  return IsLast(message.section.section, message.section.num_sections);
}
template <>
bool IsLastSection(const partial_range_image_t& message) {
  return IsLast(message.section.section, message.section.num_sections);
}
template <>
bool IsLastSection(const partial_feature_set_t& message) {
  return IsLast(message.section.section, message.section.num_sections);
}
template <>
bool IsLastSection(const shard_candidates_t& message) {
  return IsLast(message.section, message.num_sections);
}

std::optional<std::int64_t> CounterOf(const status_t& status, const std::string& name) {
  for (const counter_t& counter : status.counters)
    if (counter.name == name) return counter.value;
  return std::nullopt;
}

bool TakePrefixed(const counter_t& counter, const std::string& prefix, NamedCounts* counts) {
  if (counter.name.compare(0, prefix.size(), prefix) != 0) return false;
  if (counter.value > 0) counts->emplace_back(counter.name.substr(prefix.size()), counter.value);
  return true;
}

void SortCounters(const status_t& status, ProcessReport* report) {
  for (const counter_t& counter : status.counters) {
    const bool is_loss = TakePrefixed(counter, kDroppedPrefix, &report->drops) ||
                         TakePrefixed(counter, kRejectedPrefix, &report->rejections);
    if (!is_loss) report->counters.emplace_back(counter.name, counter.value);
  }
  report->memory_kb = CounterOf(status, kMemoryCounter);
  report->peak_memory_kb = CounterOf(status, kPeakMemoryCounter);
  report->waiting_scans = CounterOf(status, kWaitingScansCounter);
  report->waiting_messages = CounterOf(status, kWaitingMessagesCounter);
}

// As numbers of any origin, whose difference may overflow.
double Difference(std::int64_t a, std::int64_t b) {
  return static_cast<double>(a) - static_cast<double>(b);
}

}  // namespace

BusWatch::BusWatch(const Channels& channels, WatchSpan span, const CloudChannels& clouds)
    : span_(span), latency_(span == WatchSpan::kAll ? kAllScans : kLatelyScans) {
  for (const std::string& name :
       {channels.laser, channels.laser_to_local, channels.scan, channels.range_image,
        channels.features, channels.hypotheses, channels.detections, channels.status}) {
    Channel channel;
    channel.name = name;
    channels_.push_back(std::move(channel));
  }
  AddOptional<object_model_t>(channels.model);
  AddOptional<partial_scan_t>(channels.scan_ahead);
  AddOptional<scan_end_t>(channels.scan_end);
  AddOptional<partial_scan_t>(channels.partial_scan);
  AddOptional<partial_range_image_t>(channels.partial_range_image);
  AddOptional<partial_feature_set_t>(channels.partial_features);
  AddOptional<early_detections_t>(channels.early_detections);
  AddOptional<shard_t>(channels.shards);
  AddOptional<shard_scan_t>(channels.shard_scans);
  AddOptional<shard_turn_t>(channels.shard_turns);
  AddOptional<shard_candidates_t>(channels.shard_candidates);
  if (!clouds.clouds.empty()) AddOptional<bot_core::pointcloud2_t>(clouds.clouds);
  if (!clouds.poses.empty()) AddOptional<bot_core::rigid_transform_t>(clouds.poses);
}

template <typename Message>
void BusWatch::AddOptional(const std::string& name) {
  Channel channel;
  channel.name = name;
  channel.is_optional = true;
  channel.take = &TakeOptional<Message>;
  channels_.push_back(std::move(channel));
}

template <typename Message>
BusWatch::Taken BusWatch::TakeOptional(const void* bytes, std::size_t size) {
  const Decoded<Message> decoded = DecodeMessage<Message>(bytes, size);
  if (!decoded.message) return {decoded.error, false};
  return {"", IsLastSection(*decoded.message)};
}

std::vector<std::string> BusWatch::channel_names() const {
  std::vector<std::string> names;
  for (const Channel& channel : channels_) names.push_back(channel.name);
  return names;
}

void BusWatch::Take(const std::string& channel, const void* bytes, std::size_t size,
                    double arrival) {
  const auto found = std::find_if(channels_.begin(), channels_.end(),
                                  [&](const Channel& item) { return item.name == channel; });
  if (found == channels_.end()) return;
  if (begin_ < 0.0) begin_ = arrival;
  const Taken taken =
      TakeMessage(static_cast<std::size_t>(found - channels_.begin()), bytes, size, arrival);
  if (!taken.error.empty()) {
    const std::string cause = channel + ": " + taken.error;
    if (unusable_.size() < kMaxCauses || unusable_.count(cause) > 0) ++unusable_[cause];
  }
  Count(&*found, size, taken.is_whole, arrival);
}

BusWatch::Taken BusWatch::TakeMessage(std::size_t channel, const void* bytes, std::size_t size,
                                      double arrival) {
  switch (channel) {
    case kLaser: {
      const auto line = DecodeMessage<bot_core::planar_lidar_t>(bytes, size);
      if (line.message) latency_.AddLine(line.message->utime, arrival);
      return {line.error, line.message.has_value()};
    }
    case kLaserToLocal: {
      const auto pose = DecodeMessage<bot_core::rigid_transform_t>(bytes, size);
      return {pose.error, pose.message.has_value()};
    }
    case kScan:
      return TakeSection<scan_t>(StageOutput::kScan, bytes, size, arrival);
    case kRangeImage:
      return TakeSection<range_image_t>(StageOutput::kRangeImage, bytes, size, arrival);
    case kFeatures:
      return TakeSection<feature_set_t>(StageOutput::kFeatures, bytes, size, arrival);
    case kHypotheses:
      return TakeSection<pose_hypotheses_t>(StageOutput::kHypotheses, bytes, size, arrival);
    case kDetections:
      return TakeSection<detections_t>(StageOutput::kDetections, bytes, size, arrival);
    case kStatus:
      return TakeStatus(bytes, size, arrival);
    default:
      return channels_[channel].take(bytes, size);
  }
}

template <typename Message>
BusWatch::Taken BusWatch::TakeSection(StageOutput output, const void* bytes, std::size_t size,
                                      double arrival) {
  const Decoded<Message> decoded = DecodeMessage<Message>(bytes, size);
  if (!decoded.message) return {decoded.error, false};
  ArrivedSection section = SectionFrom(*decoded.message);
  section.output = output;
  return {"", latency_.AddSection(section, arrival)};
}

BusWatch::Taken BusWatch::TakeStatus(const void* bytes, std::size_t size, double arrival) {
  Decoded<status_t> decoded = DecodeMessage<status_t>(bytes, size);
  if (!decoded.message) return {decoded.error, false};
  status_t& status = *decoded.message;
  const ProcessKey key(status.process, status.host, status.pid);
  if (processes_.count(key) == 0 && processes_.size() >= kMaxProcesses) ForgetOneProcess();
  Process& process = processes_[key];
  process.last_arrival = arrival;
  process.samples.push_back(
      {status.utime, status.num_out, CounterOf(status, kCpuCounter).value_or(0)});
  if (span_ == WatchSpan::kLately && process.samples.size() > kLatelyStatuses) {
    process.samples.pop_front();
  } else if (span_ == WatchSpan::kAll && process.samples.size() > 2) {
    process.samples.erase(process.samples.begin() + 1);
  }
  process.status = std::move(status);
  return {"", true};
}

// The one that has been silent for longest.
void BusWatch::ForgetOneProcess() {
  processes_.erase(std::min_element(
      processes_.begin(), processes_.end(),
      [](const auto& a, const auto& b) { return a.second.last_arrival < b.second.last_arrival; }));
}

void BusWatch::Count(Channel* channel, std::size_t size, bool is_whole, double arrival) const {
  const auto bytes = static_cast<std::int64_t>(size);
  ++channel->messages;
  channel->wholes += is_whole;
  channel->bytes += bytes;
  if (span_ == WatchSpan::kAll) return;
  const auto number = static_cast<std::int64_t>(std::floor(arrival));
  if (channel->lately.empty() || channel->lately.back().number != number)
    channel->lately.push_back({number, 0, 0});
  channel->lately.back().wholes += is_whole;
  channel->lately.back().bytes += bytes;
  if (channel->lately.size() > static_cast<std::size_t>(kLately) + 1) channel->lately.pop_front();
}

BusReport BusWatch::Report(double now) const {
  BusReport report;
  report.duration = begin_ < 0.0 ? 0.0 : now - begin_;
  report.origin = latency_.origin();
  for (const auto& [key, process] : processes_) report.processes.push_back(ReportOf(process, now));
  for (const Channel& channel : channels_)
    if (!channel.is_optional || channel.messages > 0)
      report.channels.push_back(ReportOf(channel, now));
  for (std::size_t i = 0; i <= kStatus; ++i)
    if (const auto output = OutputOn(i)) report.channels[i].latency = latency_.Summary(*output);
  report.unusable.assign(unusable_.begin(), unusable_.end());
  return report;
}

ProcessReport BusWatch::ReportOf(const Process& process, double now) const {
  ProcessReport report;
  const status_t& status = process.status;
  report.process = status.process;
  report.host = status.host;
  report.version = status.version;
  report.pid = status.pid;
  report.silence = now - process.last_arrival;
  report.num_in = status.num_in;
  report.num_out = status.num_out;
  report.num_dropped = status.num_dropped;
  report.num_rejected = status.num_rejected;
  report.last_error = status.last_error;
  SortCounters(status, &report);
  for (const stage_time_t& stage : status.stage_times)
    report.stage_ms.emplace_back(stage.stage, stage.ms);
  const Process::Sample& first = process.samples.front();
  const Process::Sample& last = process.samples.back();
  const double seconds = 1e-6 * Difference(last.utime, first.utime);
  if (seconds <= 0.0) return report;  // a single status, or a clock that was set back
  report.out_per_second = Difference(last.num_out, first.num_out) / seconds;
  if (CounterOf(status, kCpuCounter))
    report.cpu_share = 1e-3 * Difference(last.cpu_ms, first.cpu_ms) / seconds;
  return report;
}

ChannelReport BusWatch::ReportOf(const Channel& channel, double now) const {
  ChannelReport report;
  report.channel = channel.name;
  report.num_messages = channel.messages;
  report.num_wholes = channel.wholes;
  double wholes = static_cast<double>(channel.wholes);
  double bytes = static_cast<double>(channel.bytes);
  double seconds = now - begin_;
  if (span_ == WatchSpan::kLately) {
    wholes = bytes = 0.0;
    seconds = std::min(seconds, kLately);
    for (const Second& second : channel.lately) {
      if (static_cast<double>(second.number) < now - kLately) continue;
      wholes += static_cast<double>(second.wholes);
      bytes += static_cast<double>(second.bytes);
    }
  }
  if (begin_ < 0.0 || seconds <= 0.0) return report;
  report.wholes_per_second = wholes / seconds;
  report.bytes_per_second = bytes / seconds;
  return report;
}

}  // namespace rimod
