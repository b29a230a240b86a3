#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "viewer_tools/labels.h"
#include "viewer_tools/pictures.h"

namespace rimod {
namespace {

constexpr int kBorder = 12;       // canvas pixels round everything
constexpr int kTitleHeight = 30;  // above the area
constexpr int kLeftMargin = 64;   // for the numbers of the grid
constexpr int kBottomMargin = 56;
constexpr double kShownHeight = 2.0;  // m above the floor
const cv::Scalar kBackground(32, 30, 28);
const cv::Scalar kAreaColour(22, 20, 18);
const cv::Scalar kGridColour(58, 56, 54);
const cv::Scalar kTextColour(230, 230, 230);
const cv::Scalar kSensorColour(255, 255, 255);

std::vector<Eigen::Vector3d> LocalPoints(const RangeImage& image) {
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column)
      if (image.measured(row, column))
        points.push_back(image.T_local_sensor() * image.point(row, column).cast<double>());
  return points;
}

// The value below which a share of the values lies; values must not be empty.
double Quantile(std::vector<double> values, double share) {
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

// Height of the floor, m: what nearly all points lie above.
double FloorHeight(const std::vector<Eigen::Vector3d>& points) {
  if (points.empty()) return 0.0;
  std::vector<double> heights;
  heights.reserve(points.size());
  for (const Eigen::Vector3d& p : points) heights.push_back(p.z());
  return Quantile(heights, 0.02);
}

struct Extent {
  Eigen::Vector2d min = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d max = -min;
  void Add(const Eigen::Vector2d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
};

// Whether an object is near enough to be drawn: detections of a file may be anywhere.
bool IsNear(const RangeImage& image, const DrawnObject& object) {
  constexpr double kFarthest = 1000.0;  // m from the sensor
  const Eigen::Vector3d offset =
      object.detection.T_local_object.translation() - image.T_local_sensor().translation();
  return offset.cwiseAbs().maxCoeff() < kFarthest;
}

std::vector<DrawnObject> NearObjects(const RangeImage& image,
                                     const std::vector<DrawnObject>& objects) {
  std::vector<DrawnObject> near;
  for (const DrawnObject& object : objects)
    if (IsNear(image, object)) near.push_back(object);
  return near;
}

Extent FindExtent(const RangeImage& image, const std::vector<DrawnObject>& objects) {
  constexpr double kNearShare = 0.9;  // the view out of windows must not make the room small
  Extent extent;
  const Eigen::Vector3d sensor = image.T_local_sensor().translation();
  extent.Add(sensor.head<2>());
  const std::vector<Eigen::Vector3d> points = LocalPoints(image);
  if (!points.empty()) {
    std::vector<double> distances;
    distances.reserve(points.size());
    for (const Eigen::Vector3d& p : points) distances.push_back((p - sensor).norm());
    const double shown_distance = Quantile(distances, kNearShare);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (distances[i] <= shown_distance) extent.Add(points[i].head<2>());
  }
  for (const DrawnObject& object : NearObjects(image, objects))
    for (const Eigen::Vector3d& corner : BoxCorners(object.detection)) extent.Add(corner.head<2>());
  return extent;
}

// Metres between numbers at the grid, so that they do not touch.
int NumberStep(double pixels_per_metre) {
  constexpr double kMinDistance = 45.0;  // canvas pixels
  for (const int step : {1, 2, 5, 10, 20, 50, 100})
    if (step * pixels_per_metre >= kMinDistance) return step;
  return 200;
}

void DrawGrid(const TopViewLayout& layout, cv::Mat* canvas) {
  const cv::Rect& area = layout.area;
  const double min_x = layout.max_x - area.height / layout.pixels_per_metre;
  const double min_y = layout.max_y - area.width / layout.pixels_per_metre;
  const int number_step = NumberStep(layout.pixels_per_metre);
  const int line_step = layout.pixels_per_metre >= 8.0 ? 1 : number_step;  // m
  for (int x = static_cast<int>(std::ceil(min_x)); x <= layout.max_x; ++x) {
    if (x % line_step != 0) continue;
    const int v = cvRound(layout.ToCanvas({static_cast<double>(x), 0.0, 0.0}).y);
    cv::line(*canvas, {area.x, v}, {area.br().x - 1, v}, kGridColour, 1);
    if (x % number_step != 0) continue;
    const std::string text = std::to_string(x);
    const cv::Size size = TextSize(text);
    DrawText(canvas, text, {area.x - size.width - 2, v - size.height / 2}, kTextColour);
  }
  for (int y = static_cast<int>(std::ceil(min_y)); y <= layout.max_y; ++y) {
    if (y % line_step != 0) continue;
    const int u = cvRound(layout.ToCanvas({0.0, static_cast<double>(y), 0.0}).x);
    cv::line(*canvas, {u, area.y}, {u, area.br().y - 1}, kGridColour, 1);
    if (y % number_step != 0) continue;
    const std::string text = std::to_string(y);
    DrawText(canvas, text, {u - TextSize(text).width / 2, area.br().y + 2}, kTextColour);
  }
}

void PaintPoints(const RangeImage& image, const TopViewLayout& layout, cv::Mat* canvas) {
  std::vector<Eigen::Vector3d> points = LocalPoints(image);
  const double floor = FloorHeight(points);
  points.erase(
      std::remove_if(points.begin(), points.end(),
                     [&](const Eigen::Vector3d& p) { return p.z() > floor + kShownHeight; }),
      points.end());
  // The higher one is on top.
  std::stable_sort(
      points.begin(), points.end(),
      [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.z() < b.z(); });
  for (const Eigen::Vector3d& p : points) {
    const cv::Point on_canvas(layout.ToCanvas(p));
    const cv::Rect dot = cv::Rect(on_canvas, cv::Size(2, 2)) & layout.area;
    if (dot.area() > 0)
      (*canvas)(dot).setTo(ToScalar(HeightColour((p.z() - floor) / kShownHeight)));
  }
}

void PaintSurface(const TopViewLayout& layout, const DrawnObject& object, cv::Mat* canvas) {
  const double opacity = object.is_provisional ? 0.3 : 0.6;
  for (const Eigen::Vector3f& point : object.model->points) {
    const cv::Point p(layout.ToCanvas(object.detection.T_local_object * point.cast<double>()));
    if (layout.area.contains(p))
      canvas->at<Colour>(p) = Blend(canvas->at<Colour>(p), object.colour, opacity);
  }
}

// Of the box seen from above, tilted or not.
std::vector<cv::Point> Outline(const TopViewLayout& layout, const DrawnObject& object) {
  std::vector<cv::Point> corners;
  for (const Eigen::Vector3d& corner : BoxCorners(object.detection))
    corners.push_back(cv::Point(layout.ToCanvas(corner)));
  std::vector<cv::Point> outline;
  cv::convexHull(corners, outline);
  return outline;
}

void DrawDashed(const std::vector<cv::Point>& outline, const cv::Scalar& colour, cv::Mat* canvas) {
  constexpr double kDash = 6.0;  // canvas pixels
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const cv::Point2d from = outline[i];
    const cv::Point2d side = cv::Point2d(outline[(i + 1) % outline.size()]) - from;
    const int count = std::max(1, static_cast<int>(std::min(cv::norm(side) / kDash, 1000.0)));
    for (int dash = 0; dash < count; dash += 2)
      cv::line(*canvas, from + side * (1.0 * dash / count),
               from + side * (1.0 * (dash + 1) / count), colour, 2, cv::LINE_AA);
  }
}

void DrawOutlines(const TopViewLayout& layout, const std::vector<DrawnObject>& objects,
                  cv::Mat* canvas) {
  cv::Mat area = (*canvas)(layout.area);  // clips
  for (const DrawnObject& object : objects) {
    std::vector<cv::Point> outline = Outline(layout, object);
    for (cv::Point& p : outline) p -= layout.area.tl();
    cv::polylines(area, outline, true, ToScalar(object.colour), 1, cv::LINE_AA);
  }
}

// Draws outline and heading; returns the rectangle round it.
cv::Rect DrawFootprint(const TopViewLayout& layout, const DrawnObject& object, cv::Mat* canvas) {
  const std::vector<cv::Point> outline = Outline(layout, object);
  const cv::Scalar colour = ToScalar(object.colour);
  const Eigen::Isometry3d& T_local_object = object.detection.T_local_object;
  const Eigen::Vector3d front(object.detection.box_max.x(), 0.0, 0.0);
  if (object.is_provisional) {
    DrawDashed(outline, colour, canvas);
  } else {
    cv::polylines(*canvas, outline, true, colour, 2, cv::LINE_AA);
  }
  cv::arrowedLine(*canvas, cv::Point(layout.ToCanvas(T_local_object.translation())),
                  cv::Point(layout.ToCanvas(T_local_object * (1.4 * front))), colour, 2,
                  cv::LINE_AA, 0, 0.25);
  return cv::boundingRect(outline);
}

cv::Rect DrawSensor(const RangeImage& image, const TopViewLayout& layout, cv::Mat* canvas) {
  constexpr double kLength = 16.0;  // canvas pixels
  std::vector<cv::Point> triangle;
  const double metres = kLength / layout.pixels_per_metre;
  for (const Eigen::Vector3d& corner :
       {Eigen::Vector3d(metres, 0.0, 0.0), Eigen::Vector3d(-0.5 * metres, 0.6 * metres, 0.0),
        Eigen::Vector3d(-0.5 * metres, -0.6 * metres, 0.0)}) {
    triangle.push_back(cv::Point(layout.ToCanvas(image.T_local_sensor() * corner)));
  }
  cv::fillConvexPoly(*canvas, triangle, kSensorColour, cv::LINE_AA);
  return cv::boundingRect(triangle);
}

}  // namespace

TopViewLayout LayOutTopView(const RangeImage& image, const std::vector<DrawnObject>& objects,
                            int side) {
  constexpr double kMargin = 0.5;        // m round what is shown
  constexpr double kMinWidth = 520.0;    // canvas pixels: room for the title and labels
  constexpr double kMinHeight = 240.0;   // canvas pixels
  constexpr double kMaxDensity = 200.0;  // canvas pixels a metre
  const Extent extent = FindExtent(image, objects);
  const Eigen::Vector2d size = extent.max - extent.min + Eigen::Vector2d::Constant(2.0 * kMargin);
  TopViewLayout layout;
  layout.pixels_per_metre = std::min(kMaxDensity, side / size.maxCoeff());
  const double width = std::max(kMinWidth, size.y() * layout.pixels_per_metre);
  const double height = std::max(kMinHeight, size.x() * layout.pixels_per_metre);
  layout.max_x = 0.5 * (extent.max.x() + extent.min.x()) + 0.5 * height / layout.pixels_per_metre;
  layout.max_y = 0.5 * (extent.max.y() + extent.min.y()) + 0.5 * width / layout.pixels_per_metre;
  layout.area = cv::Rect(kLeftMargin, kBorder + kTitleHeight, static_cast<int>(width),
                         static_cast<int>(height));
  layout.canvas = cv::Size(layout.area.br().x + kBorder + 24, layout.area.br().y + kBottomMargin);
  return layout;
}

cv::Mat DrawTopView(const RangeImage& image, const std::vector<DrawnObject>& all_objects,
                    const std::string& title, const PictureExtras& extras) {
  const std::vector<DrawnObject> objects = NearObjects(image, all_objects);
  const TopViewLayout layout = LayOutTopView(image, objects, extras.top_view_side);
  cv::Mat canvas(layout.canvas, CV_8UC3, kBackground);
  canvas(layout.area).setTo(kAreaColour);
  DrawText(&canvas, title, {kBorder, kBorder}, kTextColour);
  DrawText(&canvas, "from above: x [m] up, y [m] left, local frame; arrows: the objects' x",
           {kBorder, layout.area.br().y + 26}, kTextColour);
  DrawGrid(layout, &canvas);
  PaintPoints(image, layout, &canvas);
  for (const DrawnObject& object : objects)
    if (object.model != nullptr) PaintSurface(layout, object, &canvas);
  DrawOutlines(layout, NearObjects(image, extras.outlines), &canvas);

  LabelPlacer placer(layout.area);
  const cv::Rect sensor = DrawSensor(image, layout, &canvas);
  placer.AddBlocked(sensor);
  std::vector<cv::Rect> footprints;
  for (const DrawnObject& object : objects) {
    footprints.push_back(DrawFootprint(layout, object, &canvas));
    placer.AddObstacle(footprints.back());
  }
  for (std::size_t i = 0; i < objects.size(); ++i)
    DrawLabel(&canvas, &placer, objects[i].label, footprints[i], ToScalar(objects[i].colour));
  DrawLabel(&canvas, &placer, "sensor", sensor, kSensorColour);
  return canvas;
}

}  // namespace rimod
