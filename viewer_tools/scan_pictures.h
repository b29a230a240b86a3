#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rimod/hit_counting.h"
#include "rimod/object_model.h"
#include "rimod/range_image.h"

namespace rimod {

// A scan's range image and its view from above as data URIs, each with what it shows: detections
// with names, scores and, where they are counted (CountHits() of this scan alone), what is wrong
// with them; missed objects at their labels, in white.
std::vector<std::pair<std::string, std::string>> DrawScan(const std::string& name,
                                                          const RangeImage& image,
                                                          const CountedScan& scan,
                                                          const std::optional<HitCount>& count,
                                                          const std::vector<ObjectModel>& models);

}  // namespace rimod
