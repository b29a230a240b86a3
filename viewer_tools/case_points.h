#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "viewer_tools/case_picture.h"

namespace rimod {

// Side of every picture that a case has, canvas pixels.
constexpr int kCasePictureSide = 260;

// The measured points around the first pose and the models at all of them: from above, the line of
// sight upwards, and from the side, the line of sight to the right. There must be a pose.
std::vector<cv::Mat> DrawCasePoints(const RangeImage& image, const std::vector<CasePose>& poses);

}  // namespace rimod
