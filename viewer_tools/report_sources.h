#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/channels.h"
#include "io/stage_timer.h"
#include "rimod/detection.h"
#include "rimod/params.h"
#include "rimod/range_image.h"

namespace rimod {

// A scan to be reported.
struct SourceScan {
  std::string name;  // as rimod-detect names it
  RangeImage image;
  std::optional<std::vector<Detection>> detections;  // absent: the source holds none
  StageTimes stage_times;                            // as far as the source tells
};

struct SourceReport {
  int num_scans = 0;
  std::vector<std::string> errors;  // each names the file
  std::vector<std::string> warnings;
};

// Delivers the scans of a source, one after the other: of a log with detections the range images
// and detections in it, of any other log or scan file the scans.
SourceReport ReadSource(const std::string& path, const Channels& channels,
                        const PipelineParams& params, bool use_recorded_detections,
                        const std::function<void(SourceScan)>& on_scan);

// What rimod-detect --timing wrote: stage times by scan.
struct TimingFile {
  std::map<std::string, StageTimes> times;
  std::string error;  // names the file; empty when all is well
};
TimingFile ReadTimingFile(const std::string& path);

}  // namespace rimod
