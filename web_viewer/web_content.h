#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "web_viewer/client_request.h"
#include "web_viewer/page_frames.h"
#include "web_viewer/scan_history.h"

namespace rimod {

// Where a log is.
struct Playback {
  bool playing = false;
  bool at_end = false;
  double position = 0.0;  // s from the log's first message
  double duration = 0.0;  // s
  double speed = 1.0;     // times as fast as recorded
  std::string warning;    // what could not be read; empty: all is well
};

// Everything that pages are told: what does not change, the scans, and where the log is.
class WebContent {
 public:
  // hello: JSON, "type": "hello". models: frames by model name.
  WebContent(std::string hello, std::map<std::string, Frame> models,
             const HistoryLimits& limits = {})
      : hello_(MakeFrame(std::move(hello))), models_(std::move(models)), scans_(limits) {}

  // Called after each change, by the thread that made it. Set before anything changes.
  void OnChange(const std::function<void()>& on_change);
  void SetPlayback(const Playback& playback);

  ScanHistory& scans() { return scans_; }
  const ScanHistory& scans() const { return scans_; }
  const Frame& hello() const { return hello_; }
  // Null for a model that is not known.
  Frame Model(const std::string& name) const;
  // "type": "playback"; no frame while there is no log.
  ScanHistory::Part PlaybackPart() const;

 private:
  Frame hello_;
  std::map<std::string, Frame> models_;
  ScanHistory scans_;
  std::function<void()> on_change_ = [] {};
  mutable std::mutex mutex_;
  ScanHistory::Part playback_;
};

}  // namespace rimod
