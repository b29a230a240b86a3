#pragma once

#include "rimod/features.h"
#include "rimod/range_image.h"

namespace rimod {

// Whether the features can have been extracted from this image. A feature's position is the very
// point of its pixel, so that features of another image, though of the same scene, give themselves
// away by their positions: all must be points of this image, but for the last digits that another
// machine's arithmetic may round otherwise. An empty set fits every image.
bool AreFeaturesOf(const RangeImage& image, const FeatureSet& features);

}  // namespace rimod
