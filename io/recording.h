#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rimod/model_building.h"

namespace rimod {

// A recording read from its folder, or why there is none.
struct RecordingResult {
  std::optional<Recording> recording;
  std::string error;  // names the file and the cause; empty when there is a recording
  std::vector<std::string> warnings;  // scans that were left out, points that were dropped
};

// Reads `model.json` (class, object_pose [tx ty tz qw qx qy qz] object -> world, box {min, max} in
// the object frame) and every `scan_*.pcd` (points and VIEWPOINT in one world frame), sorted by
// name. Bad scans are left out with a warning; without a single good one there is no recording.
RecordingResult ReadRecording(const std::string& folder);

// The recording that `model.json` describes, without scans.
RecordingResult ReadRecordingDescription(const std::string& folder);

// The class that the model.json in this folder names; nothing when there is none or it names no
// valid class.
std::optional<std::string> ReadClassName(const std::string& folder);

}  // namespace rimod
