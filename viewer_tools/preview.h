#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "bot_core/image_t.hpp"

namespace rimod {

// A picture as other viewers show it: JPEG (PIXEL_FORMAT_MJPEG), no wider than max_width (canvas
// pixels) and small enough for a message (kMaxMessageBytes), coarser and then smaller where it must
// be. utime: us, the scan's. Nothing for an empty picture.
std::optional<bot_core::image_t> MakePreview(const cv::Mat& picture, std::int64_t utime,
                                             int max_width);

}  // namespace rimod
