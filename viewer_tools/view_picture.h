#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rimod/object_model.h"
#include "viewer_tools/pictures.h"
#include "viewer_tools/view_layers.h"
#include "viewer_tools/viewed_scan.h"

namespace rimod {

// How a scan is to be drawn.
struct ViewStyle {
  ViewLayers layers;
  bool for_screen = true;        // with the line for the mouse
  bool help = true;              // .. and the lines with the keys
  int range_image_width = 1000;  // canvas pixels
  int top_view_side = 470;       // canvas pixels
};

// The picture of a scan, with what leads from the mouse back into the scan.
struct ViewPicture {
  cv::Mat canvas;
  RangeImageLayout range_image;
  std::optional<TopViewLayout> top_view;
  cv::Point top_view_corner;  // of the view from above, on the canvas
  cv::Rect readout;           // the line for ReadOut(); none where it is not for the screen
};

// The range image with the layers, the view from above beside it, below what is seen, the legend
// and the keys. status: a word on where the scan comes from. The scan must have an image.
ViewPicture DrawView(const ViewedScan& scan, const std::vector<ObjectModel>& models,
                     const ViewStyle& style, const std::string& status);

// A picture of the same kind that says what is waited for.
cv::Mat DrawWaiting(const std::string& text);

// What is under the mouse: range, direction, point and normal of a pixel, or a place on the floor
// plan. Empty where there is neither.
std::string ReadOut(const ViewedScan& scan, const ViewPicture& picture, const cv::Point& mouse);

// Writes a text into the picture's line for it, in place of what stood there.
void DrawReadOut(const std::string& text, ViewPicture* picture);

}  // namespace rimod
