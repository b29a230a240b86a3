#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

namespace rimod {

// The bytes of a PNG file, as small as it gets; empty when the picture cannot be encoded.
std::string EncodePng(const cv::Mat& picture);

}  // namespace rimod
