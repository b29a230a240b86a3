#pragma once

#include <string>

#include "io/bus_params.h"
#include "io/process_options.h"

namespace rimod {

// Writes the next scans that come on RIMOD_SCAN as scan_000.pcd, scan_001.pcd, .. into a folder
// that holds a model.json and no scans, which makes it a recording. Ends after num_scans, or on
// SIGINT or SIGTERM with those that have come. Returns the exit code: 0 when there is at least one
// scan, 1 when not or when folder or LCM cannot be used, 2 for bad channel names; told on the log.
int RecordLive(const std::string& folder, int num_scans, const BusOptions& bus,
               const BusParams& params);

}  // namespace rimod
