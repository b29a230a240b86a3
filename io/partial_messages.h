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
#include "rimod/scan_end_t.hpp"
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

// The end of a complete sweep of whose growths the last was the step before rest (or rest itself,
// where it has lines). sweep.rest must be there.
scan_end_t ToScanEnd(const Sweep& sweep);

struct SweepEndFromMessage {
  std::optional<SweepEnd> end;
  std::string error;  // the cause; empty when there is an end
};
// Negative counts, no steps, an end before the beginning, a pose that is none give an error.
SweepEndFromMessage FromMessage(const scan_end_t& message);

// Range image and features of what is known of a sweep. known_until: us, the last beam.
std::vector<partial_range_image_t> ToPartialSections(const RangeImage& image,
                                                     std::int64_t sweep_utime,
                                                     std::int64_t known_until);
std::vector<partial_feature_set_t> ToPartialSections(const FeatureSet& features,
                                                     std::int64_t sweep_utime,
                                                     std::int64_t known_until);

}  // namespace rimod
