#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rimod/feature_set_t.hpp"
#include "rimod/features.h"

namespace rimod {

// The features as sections for RIMOD_FEATURES, at least one, each at most kSectionBytes when
// encoded. utime: us, the scan's. JoinFeatureSections gives the same features back bit for bit.
// Throws std::invalid_argument for a descriptor of another size than the set's or too large for a
// message.
std::vector<feature_set_t> ToSections(const FeatureSet& features, std::int64_t utime);

// Values of a descriptor and bytes of its kind's name that a receiver accepts.
constexpr int kMaxDescriptorSize = 4096;
constexpr int kMaxDescriptorKindBytes = 4096;

struct JoinedFeatures {
  std::optional<FeatureSet> features;
  std::string error;  // the cause; empty when there are features (maybe an empty set)
};

// The features that the sections 0 .. n - 1, in this order, make. Values that are not finite,
// normals that are not unit vectors, another unit than kDescriptorUnit, counts that do not fit
// their lists give an error.
JoinedFeatures JoinFeatureSections(const std::vector<feature_set_t>& sections);

}  // namespace rimod
