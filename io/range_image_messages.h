#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rimod/range_image.h"
#include "rimod/range_image_t.hpp"

namespace rimod {

// The range image as sections of whole rows for RIMOD_RANGE_IMAGE, at least one, each at most
// kMaxMessageBytes and, where a row is not longer, kSectionBytes when encoded. utime: us, the
// scan's. JoinRangeImageSections gives the same image back bit for bit. Throws
// std::invalid_argument for an image wider than kMaxRangeImageWidth.
std::vector<range_image_t> ToSections(const RangeImage& image, std::int64_t utime);

// Columns that a message can hold in one row, and pixels that a receiver accepts in an image.
constexpr int kMaxRangeImageWidth = 40000;
constexpr std::int64_t kMaxRangeImagePixels = 16000000;

struct JoinedRangeImage {
  std::optional<RangeImage> image;
  std::string error;  // the cause; empty when there is an image
};

// The image that the sections 0 .. n - 1, in this order, make. Absurd grids, values of another
// rounding than ours (PixelRounding), rows missing or given twice, counts that do not fit their
// lists give an error.
JoinedRangeImage JoinRangeImageSections(const std::vector<range_image_t>& sections);

}  // namespace rimod
