#include "viewer_tools/recorded_scans.h"

#include <chrono>
#include <deque>
#include <map>
#include <utility>

#include "io/event_log.h"
#include "io/message_codec.h"
#include "io/range_image_messages.h"
#include "io/section_joiner.h"
#include "rimod/status_t.hpp"

namespace rimod {
namespace {

// Images that wait for their detections: a matcher that skips scans leaves some behind.
constexpr std::size_t kMaxWaitingImages = 16;

constexpr std::size_t kMaxProcesses = 64;

class LogWalk {
 public:
  LogWalk(const Channels& channels, WantedImages wanted,
          const std::function<void(RecordedScan)>& on_scan)
      : channels_(channels), wanted_(wanted), on_scan_(on_scan) {}

  void Take(const LogEvent& event) {
    std::string error;
    if (event.channel == channels_.detections) {
      error = TakeDetections(event);
    } else if (event.channel == channels_.range_image && wanted_ == WantedImages::kAll) {
      error = TakeRangeImage(event);
    } else if (event.channel == channels_.status) {
      error = TakeStatus(event);
    }
    if (!error.empty()) ++rejected_[event.channel + ": " + error];
  }

  RecordedScansReport Finish(const std::string& path, const std::string& log_error) {
    if (!log_error.empty()) report_.errors.push_back(log_error);
    for (const auto& [cause, count] : rejected_)
      report_.errors.push_back(path + ": " + std::to_string(count) + " message(s) left out, " +
                               cause);
    for (auto& [process, times] : process_times_)
      if (!times.empty()) report_.process_times.push_back({process, std::move(times)});
    return std::move(report_);
  }

 private:
  std::string TakeDetections(const LogEvent& event) {
    const Decoded<detections_t> decoded =
        DecodeMessage<detections_t>(event.bytes.data(), event.bytes.size());
    if (!decoded.message) return decoded.error;
    DetectionsFromMessage converted = FromMessage(*decoded.message);
    if (!converted.detections) return converted.error;
    RecordedScan scan{std::move(*converted.detections), std::nullopt};
    for (auto image = images_.begin(); image != images_.end(); ++image) {
      if (image->first != scan.detections.utime) continue;
      scan.image = std::move(image->second);
      images_.erase(image);
      break;
    }
    ++report_.num_scans;
    on_scan_(std::move(scan));
    return "";
  }

  std::string TakeRangeImage(const LogEvent& event) {
    Decoded<range_image_t> decoded =
        DecodeMessage<range_image_t>(event.bytes.data(), event.bytes.size());
    if (!decoded.message) return decoded.error;
    const std::int64_t utime = decoded.message->utime;
    const SectionJoiner<range_image_t>::Time now{std::chrono::microseconds(event.utime)};
    const auto sections = joiner_.Add(std::move(*decoded.message), now);
    if (!sections) return "";
    JoinedRangeImage joined = JoinRangeImageSections(*sections);
    if (!joined.image) return joined.error;
    images_.emplace_back(utime, std::move(*joined.image));
    if (images_.size() > kMaxWaitingImages) images_.pop_front();
    return "";
  }

  std::string TakeStatus(const LogEvent& event) {
    const Decoded<status_t> decoded =
        DecodeMessage<status_t>(event.bytes.data(), event.bytes.size());
    if (!decoded.message) return decoded.error;
    StageTimes times;
    for (const stage_time_t& stage : decoded.message->stage_times)
      times.emplace_back(stage.stage, stage.ms);
    const std::string& process = decoded.message->process;
    if (process_times_.size() >= kMaxProcesses && process_times_.count(process) == 0)
      return "too many different processes";
    process_times_[process] = std::move(times);
    return "";
  }

  const Channels& channels_;
  WantedImages wanted_;
  const std::function<void(RecordedScan)>& on_scan_;
  SectionJoiner<range_image_t> joiner_;
  std::deque<std::pair<std::int64_t, RangeImage>> images_;  // by utime
  std::map<std::string, StageTimes> process_times_;
  std::map<std::string, int> rejected_;  // by channel and cause
  RecordedScansReport report_;
};

}  // namespace

RecordedScansReport ReadRecordedScans(const std::string& path, const Channels& channels,
                                      WantedImages wanted,
                                      const std::function<void(RecordedScan)>& on_scan) {
  EventLogReader log(path);
  LogWalk walk(channels, wanted, on_scan);
  while (const std::optional<LogEvent> event = log.Next()) walk.Take(*event);
  return walk.Finish(path, log.error());
}

}  // namespace rimod
