#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "rimod/scan.h"
#include "rimod/sweep_assembler.h"

namespace rimod {

// A scan as rimod-detect names it.
struct NamedScan {
  std::string
      name;  // file name without folder and ending; `#0`, `#1`, .. added when a log has several
  std::int64_t utime = 0;    // us, first beam; 0 where the source does not tell
  double assembly_ms = 0.0;  // wall time to join the scan from its log; 0 for other files
  bool from_log = false;
  Scan scan;
};

// What went wrong with a source while its scans were delivered; each text names the file.
struct ScanSourceReport {
  int num_scans = 0;
  std::vector<std::string> errors;    // something could not be read
  std::vector<std::string> warnings;  // all was read, but something is worth telling
};

// Delivers every scan of a PCD, PLY or 3DTK file or of an LCM log (all recognised by content), in
// order. A log's scans are the sweeps assembled from LASER and LASER_TO_LOCAL; a log without LASER
// but with RIMOD_SCAN gives those. At most two scans are held at a time.
ScanSourceReport ReadScans(const std::string& path, const SweepParams& params,
                           const std::function<void(NamedScan)>& on_scan);

}  // namespace rimod
