#pragma once

#include <string>

#include "io/channels.h"
#include "rimod/params.h"

namespace rimod {

// What to draw, from where and where to.
struct SnapshotOptions {
  std::string models;      // folder of the models that were looked for
  std::string log;         // LCM log with range images and detections; or, if empty:
  std::string scan;        // scan file or log, and
  std::string detections;  // rimod-detect's output for it
  std::string output;      // folder for the pictures; made when missing
  int max_scans = 20;      // that get pictures; >= 1
  Channels channels;
  PipelineParams params;  // for range images of scan files
};

// Draws each scan's range image and view from above, writes NAME_range_image.png and
// NAME_from_above.png into the output folder and prints their paths on stdout. NAME is that of the
// log or scan file, with "-0",
// "-1", .. when it holds several scans. Returns the exit code: 0, or 1 when something could not be
// read or written (told on stderr; the rest is drawn).
int RunSnapshot(const SnapshotOptions& options);

}  // namespace rimod
