#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>

#include "io/detection_messages.h"
#include "io/early_messages.h"
#include "rimod/range_image.h"
#include "rimod/scan.h"
#include "web_viewer/page_frames.h"

namespace rimod {

struct HistoryLimits {
  std::size_t max_scans = 100;
  std::size_t max_bytes = 256'000'000;  // of frames; the newest scan stays even if it is longer
};

// What the page can show: the last scans with their objects, ready to be sent. Written by one
// thread, read by others; nobody waits for a client.
class ScanHistory {
 public:
  // A frame and the version of what it tells: another version, another frame. Versions are never
  // used twice, 0 is none.
  struct Part {
    std::int64_t version = 0;
    Frame frame;
  };

  explicit ScanHistory(const HistoryLimits& limits = {}) : limits_(limits) {}

  // Called after each change, by the thread that made it. Set before anything changes.
  void OnChange(std::function<void()> on_change) { on_change_ = std::move(on_change); }

  // A scan, by its utime: becomes the newest and replaces one of the same utime, which keeps its
  // objects.
  void SetScan(std::int64_t utime, const Scan& scan);
  // The same from what the detector works on, unless the scan itself came.
  void SetRangeImage(std::int64_t utime, const RangeImage& image);
  void SetDetections(const StampedDetections& detections);
  void SetHypotheses(std::int64_t utime, std::vector<PoseHypothesis> hypotheses, int num_found);
  void SetEarlyObjects(const StampedEarlyObjects& early);

  // Of the scan with this id, or of the newest that has such a part: version 0 where there is none.
  Part ScanPart(std::optional<std::int64_t> id) const;
  Part ObjectsPart(std::optional<std::int64_t> id) const;
  // "type": "timeline" with the "scans" that are kept, the oldest first: id, utime, num_points,
  // num_detections (null: not known).
  Part TimelinePart() const;
  bool Has(std::int64_t id) const;

 private:
  enum class Source { kNone, kRangeImage, kScan };
  struct Entry {
    std::int64_t id = 0;
    std::int64_t utime = 0;
    Source source = Source::kNone;
    std::size_t num_points = 0;
    Part scan;
    SceneObjects objects;
    Part objects_part;
    std::size_t bytes() const;
  };

  void StoreScan(std::int64_t utime, const Scan& scan, Source source);
  // Changes the objects of a scan and makes their frame anew.
  void ChangeObjects(std::int64_t utime, const std::function<void(SceneObjects*)>& change);
  // With the mutex held:
  Entry* FindOrAdd(std::int64_t utime);
  const Entry* Find(std::int64_t id) const;
  void MarkChanged();
  void ForgetOldest();

  const HistoryLimits limits_;
  std::function<void()> on_change_ = [] {};
  mutable std::mutex mutex_;
  std::list<Entry> entries_;  // oldest first
  std::int64_t last_id_ = 0;
  std::int64_t last_version_ = 0;
  std::int64_t timeline_version_ = 0;
  mutable Part timeline_;  // as last asked for
};

}  // namespace rimod
