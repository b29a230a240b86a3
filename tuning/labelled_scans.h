#pragma once

#include <atomic>
#include <map>
#include <string>
#include <vector>

#include "io/scan_source.h"
#include "rimod/hit_counting.h"

namespace rimod {

// A scan with what is in it.
struct LabelledInput {
  std::string name;
  int source = 0;  // number of the log or file that it comes from
  Scan scan;
  std::vector<LabelledObject> objects;
};

struct LabelledInputs {
  std::vector<LabelledInput> scans;  // in the order of the sources
  int num_unlabelled = 0;            // scans left out, as no label names them
  int num_absent = 0;                // labelled scans that are in none of the sources
  std::vector<std::string> warnings;
  std::string error;  // names the file or scan; not empty: there are no scans to work with
};

// Reads all scans of the sources that the labels name. Sources that cannot be read in full, scans
// of one name and labels without a counting object are errors; the work ends soon after stop is
// set, with an error.
LabelledInputs ReadLabelledInputs(const std::vector<std::string>& sources,
                                  const std::string& labels, const ScanSourceParams& params,
                                  const std::atomic<bool>& stop);

}  // namespace rimod
