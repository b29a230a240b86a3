#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "io/channels.h"
#include "io/config.h"
#include "io/event_log.h"
#include "web_viewer/client_request.h"
#include "web_viewer/scan_detector.h"
#include "web_viewer/web_content.h"

namespace rimod {

// What a log holds, as far as a player wants to know.
struct LogSummary {
  bool has_scans = false;  // or range images
  bool has_lines = false;  // of a laser, with its poses
  bool has_detections = false;
  std::int64_t begin = 0;  // us, clock of the logger
  std::int64_t end = 0;
  std::string error;  // what could not be read
  bool can_be_shown() const { return has_scans || has_lines || has_detections; }
};
LogSummary SummariseLog(const std::string& path, const Channels& channels);

struct LogPlayerOptions {
  std::string path;
  Channels channels;
  Configuration configuration;
  double speed = 1.0;  // times as fast as recorded
};

// Plays a log of lcm-logger into the history at its own pace, in a thread of its own; assembles
// scans of laser lines where it holds no scans.
class LogPlayer {
 public:
  // Plays at once. detector: for logs without detections; null: none. content must outlive it.
  LogPlayer(const LogPlayerOptions& options, const LogSummary& log,
            std::unique_ptr<ScanDetector> detector, WebContent* content);
  ~LogPlayer();
  LogPlayer(const LogPlayer&) = delete;
  LogPlayer& operator=(const LogPlayer&) = delete;

  // From any thread. A step goes on to the next scan with its detections and rests there.
  void Take(const ClientRequest& request);

 private:
  using Clock = std::chrono::steady_clock;
  class Stage;

  void Run();
  // Plays from the beginning until the end, a restart or a stop.
  void PlayOnce();
  // Waits until the message of this time (s from the log's beginning) is due; false to break off.
  bool WaitFor(double position);
  void Rest();
  // With the mutex held:
  void Anchor();
  Clock::time_point DueTime(double position) const;
  void Tell(std::unique_lock<std::mutex>* lock);

  const LogPlayerOptions options_;
  const LogSummary log_;
  std::unique_ptr<ScanDetector> detector_;
  WebContent* content_;

  std::mutex mutex_;
  std::condition_variable changed_;
  Playback playback_;
  bool stepping_ = false;
  bool restart_ = false;
  bool stop_ = false;
  double anchor_position_ = 0.0;  // s, that is due at anchor_time_
  Clock::time_point anchor_time_;
  Clock::time_point next_tell_;

  std::thread thread_;
};

}  // namespace rimod
