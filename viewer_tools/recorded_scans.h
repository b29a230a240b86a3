#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/channels.h"
#include "io/detection_messages.h"
#include "rimod/range_image.h"
#include "viewer_tools/detection_table.h"

namespace rimod {

// The detections of one scan with the range image that they were found in.
struct RecordedScan {
  StampedDetections detections;
  std::optional<RangeImage> image;  // none: not wanted, or not whole in the log
};

// What a log told besides its scans.
struct RecordedScansReport {
  int num_scans = 0;                        // with detections
  std::vector<ProcessTimes> process_times;  // of every process's last status, by name
  std::vector<std::string> errors;  // the log could not be read; messages not usable, by cause
};

enum class WantedImages { kNone, kAll };

// Delivers the detections recorded in a log of lcm-logger, in the log's order, each with the range
// image of the same utime if wanted. Keeps a bounded number of images that still wait for their
// detections.
RecordedScansReport ReadRecordedScans(const std::string& path, const Channels& channels,
                                      WantedImages wanted,
                                      const std::function<void(RecordedScan)>& on_scan);

}  // namespace rimod
