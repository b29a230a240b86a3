#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "rimod/detection.h"
#include "rimod/object_model.h"
#include "rimod/range_image.h"
#include "viewer_tools/palette.h"

namespace rimod {

// A found object as the pictures show it.
struct DrawnObject {
  Detection detection;
  const ObjectModel* model = nullptr;  // null: the box is drawn without the surface
  Colour colour;
  std::string label;            // name and score
  bool is_provisional = false;  // told before the sweep has ended: drawn fainter, dashed
};

// The detections of one scan with their models (looked up by name), a colour a class. The models
// must outlive the result.
std::vector<DrawnObject> MakeDrawnObjects(const std::vector<Detection>& detections,
                                          const std::vector<ObjectModel>& models);

// The eight corners of a detection's box in the local frame, m: bit 0 of the index tells x (0 =
// min), bit 1 y, bit 2 z.
std::vector<Eigen::Vector3d> BoxCorners(const Detection& detection);

// A place in the scan that a picture points out.
struct MarkedPoint {
  Eigen::Vector3d p_sensor = Eigen::Vector3d::Zero();  // m, level sensor frame
  Colour colour;
  bool large = false;
};

// What else a picture shows, and how large it is.
struct PictureExtras {
  std::vector<MarkedPoint> points;    // range image only
  std::vector<DrawnObject> outlines;  // boxes in thin lines; neither surface nor label
  int range_image_width = 1400;       // canvas pixels at most, unless the image has more columns
  int top_view_side = 960;            // canvas pixels, of the longer side
};

// Where DrawRangeImage puts the pixels of the range image.
struct RangeImageLayout {
  int scale = 1;    // canvas pixels a range image pixel
  cv::Rect area;    // of the image on the canvas
  cv::Size canvas;  // of the whole picture

  // Canvas position of a position in the range image (pixel centres at k + 0.5).
  cv::Point2d ToCanvas(const PixelPosition& position) const {
    return {area.x + position.column * scale, area.y + position.row * scale};
  }
};
RangeImageLayout LayOutRangeImage(const RangeImage& image,
                                  int target_width = PictureExtras().range_image_width);

// The range image, near light and far dark, with the objects drawn in: the points of the model
// that the sensor should see and that nothing hides, the box, name and score. Never observed pixels
// are hatched, those without a return plain violet. Above stands the title, below a legend and the
// azimuth in degrees. An image of size 0 gives a picture that says so.
cv::Mat DrawRangeImage(const RangeImage& image, const std::vector<DrawnObject>& objects,
                       const std::string& title, const PictureExtras& extras = {});

// Where DrawTopView puts the local frame: x upwards, y to the left.
struct TopViewLayout {
  double pixels_per_metre = 100.0;
  double max_x = 0.0;  // m, local frame, upper edge of the area
  double max_y = 0.0;  // m, left edge
  cv::Rect area;
  cv::Size canvas;

  cv::Point2d ToCanvas(const Eigen::Vector3d& p_local) const {
    return {area.x + (max_y - p_local.y()) * pixels_per_metre,
            area.y + (max_x - p_local.x()) * pixels_per_metre};
  }
};
// Shows the sensor, the objects and the nearest nine tenths of the points.
TopViewLayout LayOutTopView(const RangeImage& image, const std::vector<DrawnObject>& objects,
                            int side = PictureExtras().top_view_side);

// The image's points from above, low ones dark and high ones light, without those above 2 m over
// the floor (ceilings), with the objects' surface, footprint and heading (a line along x), names
// and scores, a metre grid of the local frame and the sensor. Objects more than 1 km away are left
// out.
cv::Mat DrawTopView(const RangeImage& image, const std::vector<DrawnObject>& all_objects,
                    const std::string& title, const PictureExtras& extras = {});

}  // namespace rimod
