#pragma once

#include <string>
#include <vector>

#include "io/channels.h"
#include "rimod/hit_counting.h"
#include "rimod/params.h"

namespace rimod {

// What to report, from where and where to.
struct ReportOptions {
  std::string models;                // folder of the models that were looked for
  std::vector<std::string> sources;  // logs with detections; or logs and scan files
  std::string detections;  // rimod-detect's output for the sources; empty: what their logs hold,
                           // and where they hold none the detector is run
  std::string timing;      // rimod-detect's stage times for the sources; empty: as measured here
  std::string labels;      // empty: none, and so no misses and false alarms
  std::string recordings;  // folder of the models' recordings, for their symmetries; may be empty
  std::string output;      // the HTML file
  std::string cases;       // folder for a picture of each case and a list of them; empty: none
  int max_pictures = 200;  // scans with pictures; further ones stand in the tables only; >= 0
  int max_cases = 1000;    // with pictures, likewise; >= 0
  int num_threads = 0;     // 0: as many as the machine has
  HitParams hits;
  Channels channels;
  PipelineParams params;
};

// Writes the report, prints its path and the totals on stdout. Returns the exit code: 0, or 1 when
// something could not be read or written (told on stderr and in the report; the rest is done).
int RunReport(const ReportOptions& options);

}  // namespace rimod
