#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "rimod/object_model.h"
#include "rimod/range_image.h"
#include "viewer_tools/palette.h"

namespace rimod {

// An object at a pose that a case is about.
struct CasePose {
  std::string title;  // short, such as "label" or "p 0.31"
  const ObjectModel* model = nullptr;
  Eigen::Isometry3d T_local_object = Eigen::Isometry3d::Identity();
  Colour colour;
};

// From blue where the scene is nearer than the model (hidden) over white to red where it is farther
// (seen through); difference: measured less rendered range, m.
Colour DepthDifferenceColour(double difference);

// A row of pictures of one place that show why something was missed or invented there: the range
// image with the outlines of all poses; for each of the first two poses measured against rendered
// depth; the measured points and the models from above and from the side. The poses' models must
// not be null. A legend stands below.
cv::Mat DrawCase(const RangeImage& image, const std::vector<CasePose>& poses,
                 const std::string& title);

}  // namespace rimod
