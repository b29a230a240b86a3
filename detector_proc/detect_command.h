#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "io/channels.h"
#include "io/config.h"

namespace rimod {

// What rimod-detect was asked to do.
struct DetectOptions {
  std::string models;              // folder with *.rimod
  int num_threads = 0;             // 0: as many as the machine has
  CloudChannels clouds;            // of point clouds in logs
  std::string timing;              // file for stage times; empty: none
  std::vector<std::string> scans;  // files: PCD, PLY, 3DTK .3d, LCM logs
};

// Finds the models' objects in the scans, one after the other. Writes a JSON object a line and
// detection to `out`, in the order of the scans, then by falling score; messages go to the log.
// Returns the exit code: 0 done, 1 an input (models folder, model, scan) could not be read or an
// output not written; everything else was done nevertheless.
int RunDetect(const DetectOptions& options, const Configuration& configuration, std::ostream& out);

}  // namespace rimod
