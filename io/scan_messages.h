#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rimod/scan.h"
#include "rimod/scan_t.hpp"

namespace rimod {

// A scan with what its messages say about it.
struct StampedScan {
  std::int64_t utime = 0;      // us, first beam: names the scan on every channel
  std::int64_t utime_end = 0;  // us, last beam
  int num_lines = 0;
  int num_missing_lines = 0;
  Scan scan;
};

// The scan as sections for RIMOD_SCAN, at least one, each at most kSectionBytes when encoded.
// JoinScanSections gives the same scan back bit for bit; T_local_sensor must be level.
std::vector<scan_t> ToSections(const StampedScan& scan);

struct JoinedScan {
  std::optional<StampedScan> scan;
  std::string error;  // the cause; empty when there is a scan
};

// The scan that the sections 0 .. n - 1, in this order, make. Values that are not finite,
// directions that are not unit vectors, counts that do not fit their lists, sections of different
// scans give an error.
JoinedScan JoinScanSections(const std::vector<scan_t>& sections);

}  // namespace rimod
