#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/feature_messages.h"
#include "io/range_image_messages.h"
#include "io/scan_messages.h"
#include "rimod/partial_feature_set_t.hpp"
#include "rimod/partial_range_image_t.hpp"
#include "rimod/partial_scan_t.hpp"
#include "rimod/sweep.h"

namespace rimod {

// Messages of sweeps that still go on. Each is a section of a whole, as a scan, an image or a
// feature set travels, together with the sweep that it belongs to. The inner sections are joined as
// those of whole scans are; their utime differs from step to step of a sweep.

// Growth of a sweep as sections for RIMOD_SCAN_PARTIAL. SweepGrowthFrom gives it back bit for bit.
std::vector<partial_scan_t> ToPartialSections(const SweepGrowth& growth);

struct JoinedSweepGrowth {
  std::optional<SweepGrowth> growth;
  std::string error;  // the cause; empty when there is a growth
};
// The growth that the joined inner sections make; sweep_utime (us) and step as any of their
// messages tells them. Errors as JoinScanSections, and for growth that began before its sweep or a
// negative step.
JoinedSweepGrowth SweepGrowthFrom(std::int64_t sweep_utime, int step,
                                  const std::vector<scan_t>& sections);

// Range image and features of what is known of a sweep. known_until: us, the last beam.
std::vector<partial_range_image_t> ToPartialSections(const RangeImage& image,
                                                     std::int64_t sweep_utime,
                                                     std::int64_t known_until);
std::vector<partial_feature_set_t> ToPartialSections(const FeatureSet& features,
                                                     std::int64_t sweep_utime,
                                                     std::int64_t known_until);

}  // namespace rimod
