#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/channels.h"
#include "rimod/cloud_placer.h"
#include "rimod/scan.h"
#include "rimod/sweep_assembler.h"

namespace rimod {

// A scan as rimod-detect names it.
struct NamedScan {
  std::string
      name;  // file name without folder and ending; `#0`, `#1`, .. added when a log has several
  std::int64_t utime = 0;      // us, first beam; 0 where the source does not tell
  std::int64_t utime_end = 0;  // us, last beam; likewise
  double assembly_ms = 0.0;    // wall time to join the scan from its log; 0 for other files
  bool from_log = false;
  Scan scan;
};

// What went wrong with a source while its scans were delivered; each text names the file.
struct ScanSourceReport {
  int num_scans = 0;
  std::vector<std::string> errors;    // something could not be read
  std::vector<std::string> warnings;  // all was read, but something is worth telling
};

// How scans are made of what a source holds.
struct ScanSourceParams {
  SweepParams sweep;
  // Point clouds in logs: on which channels, and where their sensor is.
  CloudChannels cloud_channels;
  CloudParams cloud;
  // Told what the sweeps of a log grow by, every growth_period (s) of them, before the scan.
  double growth_period = 1.0;
  std::function<void(const SweepGrowth&)> on_growth;
};

// Delivers every scan of a PCD, PLY or 3DTK file or of an LCM log (all recognised by content), in
// order. A log's scans are its point clouds where a cloud channel is given; else the sweeps
// assembled from LASER and LASER_TO_LOCAL; a log without LASER but with RIMOD_SCAN gives those. At
// most two scans are held at a time, and clouds that wait for a pose.
ScanSourceReport ReadScans(const std::string& path, const ScanSourceParams& params,
                           const std::function<void(NamedScan)>& on_scan);

// The same with all other parameters as they are.
ScanSourceReport ReadScans(const std::string& path, const SweepParams& params,
                           const std::function<void(NamedScan)>& on_scan);

}  // namespace rimod
