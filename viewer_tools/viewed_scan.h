#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/detection_messages.h"
#include "io/early_messages.h"
#include "rimod/detection.h"
#include "rimod/features.h"
#include "rimod/range_image.h"

namespace rimod {

// Pose hypotheses of a scan.
struct ViewedHypotheses {
  int num_found = 0;  // more than are listed when there are very many
  std::vector<PoseHypothesis> listed;
};

// What the pipeline told of one scan, or of a sweep that still goes on, as far as it is known.
struct ViewedScan {
  std::string name;              // empty: it has but its utime
  std::int64_t utime = 0;        // us, the scan's, or of the sweep's first beam
  std::int64_t known_until = 0;  // us, last beam in the image of a sweep that still goes on; else 0
  std::optional<RangeImage> image;
  std::optional<FeatureSet> features;
  std::optional<ViewedHypotheses> hypotheses;
  std::optional<StampedDetections> detections;
  std::optional<StampedEarlyObjects> early;  // told before the sweep had ended

  bool is_partial() const { return known_until != 0; }
};

}  // namespace rimod
