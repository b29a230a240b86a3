#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/channels.h"
#include "io/config.h"
#include "rimod/object_model.h"
#include "viewer_tools/viewed_scan.h"

namespace rimod {

struct ViewSourceReport {
  int num_scans = 0;                // delivered
  std::vector<std::string> errors;  // each names the file
  std::vector<std::string> warnings;
};

// Delivers what a file holds, one scan after the other, until on_scan returns false: of a log with
// range images what the stages said, sweeps that still went on included; of any other log or scan
// file the scans, with the stages run here (without models up to the features).
ViewSourceReport ReadViewedScans(const std::string& path, const Channels& channels,
                                 const Configuration& configuration,
                                 const std::vector<ObjectModel>& models,
                                 const std::function<bool(ViewedScan)>& on_scan);

}  // namespace rimod
