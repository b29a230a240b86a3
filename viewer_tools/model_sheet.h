#pragma once

#include <opencv2/core/mat.hpp>

#include "rimod/object_model.h"

namespace rimod {

// A contact sheet of a model: its surface from four sides and from above, and up to fifteen of its
// views as range images of the given resolution (rad per pixel) with their features, validation
// points and outside points. A model without points or views gives a sheet that says so.
cv::Mat DrawModelSheet(const ObjectModel& model, double resolution);

}  // namespace rimod
