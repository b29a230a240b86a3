#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rimod/early_detection.h"
#include "rimod/early_detections_t.hpp"

namespace rimod {

// What is known of a sweep's objects, with what a receiver needs to use it.
struct StampedEarlyObjects {
  std::int64_t utime = 0;                                            // us, first beam of the sweep
  std::int64_t known_until = 0;                                      // us, last beam that was known
  bool is_final = false;                                             // the sweep has ended
  Eigen::Isometry3d T_local_sensor = Eigen::Isometry3d::Identity();  // level
  int num_models = 0;                                                // that were looked for
  std::vector<EarlyObject> objects;
};

// Holds as many as fit into kMaxMessageBytes, the first ones.
early_detections_t ToMessage(const StampedEarlyObjects& early);

struct EarlyObjectsFromMessage {
  std::optional<StampedEarlyObjects> early;
  std::string error;  // the cause; empty when there are objects (maybe an empty list)
};
// The errors of detections, and unknown states and shares out of range.
EarlyObjectsFromMessage FromMessage(const early_detections_t& message);

}  // namespace rimod
