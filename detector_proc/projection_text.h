#pragma once

namespace rimod {

// What is told of scans with IsTooWideForPinhole.
constexpr const char* kTooWideText =
    "the field of view is too wide for range_image.projection: pinhole; range images are spherical";

}  // namespace rimod
