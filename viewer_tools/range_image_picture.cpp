#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "viewer_tools/labels.h"
#include "viewer_tools/pictures.h"
#include "viewer_tools/range_colours.h"

namespace rimod {
namespace {

constexpr int kBorder = 12;  // canvas pixels round everything
constexpr int kTitleHeight = 30;
constexpr int kFooterHeight = 76;
constexpr int kMinWidth = 700;  // the legend needs it
const cv::Scalar kBackground(32, 30, 28);
const cv::Scalar kTextColour(230, 230, 230);
const cv::Scalar kDark(16, 16, 16);

RangeSpan FindSpan(const RangeImage& image) {
  std::vector<float> ranges;
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column)
      if (image.measured(row, column)) ranges.push_back(image.range(row, column));
  // Single near readings and the view out of windows must not take the colours of the room.
  return SpanOf(std::move(ranges), 0.01, 0.1);
}

void PaintPixels(const RangeImage& image, const RangeImageLayout& layout, const RangeSpan& span,
                 cv::Mat* canvas) {
  for (int y = layout.area.y; y < layout.area.br().y; ++y) {
    for (int x = layout.area.x; x < layout.area.br().x; ++x) {
      const int row = (y - layout.area.y) / layout.scale;
      const int column = (x - layout.area.x) / layout.scale;
      canvas->at<Colour>(y, x) = PixelColour(image, row, column, span, x, y);
    }
  }
}

// What the sensor sees at each canvas pixel of the area: range in m, infinity where nothing is.
// Objects and scene write into it, so that the nearest wins.
class DepthBuffer {
 public:
  explicit DepthBuffer(const cv::Rect& area)
      : area_(area), depth_(area.height, area.width, std::numeric_limits<float>::infinity()) {}

  // True when nothing nearer than range (m), less a tolerance (m), is there.
  bool Sees(const cv::Point& p, double range, double tolerance) const {
    return area_.contains(p) && range - tolerance <= depth_(p - area_.tl());
  }
  void Put(const cv::Point& p, double range) {
    if (!area_.contains(p)) return;
    float& depth = depth_(p - area_.tl());
    depth = std::min(depth, static_cast<float>(range));
  }

 private:
  cv::Rect area_;
  cv::Mat_<float> depth_;
};

// The scene, against which objects are hidden.
DepthBuffer SceneDepth(const RangeImage& image, const RangeImageLayout& layout) {
  DepthBuffer scene(layout.area);
  for (int y = layout.area.y; y < layout.area.br().y; ++y) {
    for (int x = layout.area.x; x < layout.area.br().x; ++x) {
      const int row = (y - layout.area.y) / layout.scale;
      const int column = (x - layout.area.x) / layout.scale;
      if (image.measured(row, column)) scene.Put({x, y}, image.range(row, column));
    }
  }
  return scene;
}

// A surface point of an object on the canvas.
struct Splat {
  cv::Point centre;
  int radius = 1;  // canvas pixels
  double range = 0.0;
};

// The model's points whose normals face the sensor.
std::vector<Splat> ProjectSurface(const RangeImage& image, const RangeImageLayout& layout,
                                  const DrawnObject& object) {
  const ObjectModel& model = *object.model;
  const Eigen::Isometry3d T_sensor_object =
      image.T_local_sensor().inverse() * object.detection.T_local_object;
  std::vector<Splat> splats;
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const Eigen::Vector3d p_sensor = T_sensor_object * model.points[i].cast<double>();
    const double range = p_sensor.norm();
    const Eigen::Vector3d normal = T_sensor_object.linear() * model.normals[i].cast<double>();
    if (range < 1e-3 || normal.dot(p_sensor) > 0.0) continue;
    const cv::Point2d centre = layout.ToCanvas(Project(image.grid(), p_sensor));
    if (!layout.area.contains(cv::Point(centre))) continue;
    const double size = model.point_spacing / range / PixelAngle(image.grid(), p_sensor) *
                        layout.scale;  // canvas pixels
    splats.push_back({cv::Point(centre), std::clamp(static_cast<int>(size / 2), 1, 6), range});
  }
  return splats;
}

template <typename Function>
void ForEachPixel(const Splat& splat, const Function& function) {
  for (int dy = -splat.radius; dy <= splat.radius; ++dy)
    for (int dx = -splat.radius; dx <= splat.radius; ++dx)
      function(splat.centre + cv::Point(dx, dy));
}

void PaintSurface(const RangeImage& image, const RangeImageLayout& layout, const DepthBuffer& scene,
                  const DrawnObject& object, cv::Mat* canvas) {
  constexpr double kSceneTolerance = 0.08;  // m: the scene may stand this far before the model
  constexpr double kOwnTolerance = 0.05;    // m: points behind others of the model are not seen
  const double opacity = object.is_provisional ? 0.3 : 0.55;
  const std::vector<Splat> splats = ProjectSurface(image, layout, object);
  DepthBuffer own(layout.area);
  for (const Splat& splat : splats)
    ForEachPixel(splat, [&](const cv::Point& p) { own.Put(p, splat.range); });
  cv::Mat_<unsigned char> mask(canvas->size(), 0);
  for (const Splat& splat : splats) {
    ForEachPixel(splat, [&](const cv::Point& p) {
      if (own.Sees(p, splat.range, kOwnTolerance) && scene.Sees(p, splat.range, kSceneTolerance))
        mask(p) = 1;
    });
  }
  for (int y = layout.area.y; y < layout.area.br().y; ++y)
    for (int x = layout.area.x; x < layout.area.br().x; ++x)
      if (mask(y, x))
        canvas->at<Colour>(y, x) = Blend(canvas->at<Colour>(y, x), object.colour, opacity);
}

// Straight edges of the box are curves in a spherical image.
std::vector<std::vector<cv::Point>> ProjectEdges(const RangeImage& image,
                                                 const RangeImageLayout& layout,
                                                 const Detection& detection) {
  constexpr int kSteps = 24;
  const std::vector<Eigen::Vector3d> corners = BoxCorners(detection);
  const Eigen::Isometry3d T_sensor_local = image.T_local_sensor().inverse();
  const int half_width = layout.area.width / 2;
  std::vector<std::vector<cv::Point>> lines;
  for (int a = 0; a < 8; ++a) {
    for (const int bit : {1, 2, 4}) {
      if (a & bit) continue;
      std::vector<cv::Point> line;
      for (int step = 0; step <= kSteps; ++step) {
        const double share = static_cast<double>(step) / kSteps;
        const Eigen::Vector3d p_sensor =
            T_sensor_local * (corners[a] * (1.0 - share) + corners[a | bit] * share);
        if (p_sensor.norm() < 1e-3 || !CanHold(image.grid(), p_sensor)) continue;
        const cv::Point p(layout.ToCanvas(Project(image.grid(), p_sensor)));
        // A jump across the image is where the azimuth wraps behind the sensor.
        if (!line.empty() && std::abs(p.x - line.back().x) > half_width) break;
        line.push_back(p);
      }
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

void DrawDashes(cv::Mat* area, const std::vector<cv::Point>& line, const cv::Scalar& colour,
                int thickness) {
  for (std::size_t i = 0; i + 1 < line.size(); i += 2)
    cv::line(*area, line[i], line[i + 1], colour, thickness, cv::LINE_AA);
}

// Draws the box, dashed where that is asked for, and returns the rectangle round it.
cv::Rect DrawBox(const RangeImage& image, const RangeImageLayout& layout, const DrawnObject& object,
                 const std::vector<std::pair<int, cv::Scalar>>& strokes, cv::Mat* canvas) {
  const std::vector<std::vector<cv::Point>> lines = ProjectEdges(image, layout, object.detection);
  cv::Mat area = (*canvas)(layout.area);  // clips
  std::vector<cv::Point> all;
  for (const auto& [thickness, colour] : strokes) {
    for (std::vector<cv::Point> line : lines) {
      all.insert(all.end(), line.begin(), line.end());
      for (cv::Point& p : line) p -= layout.area.tl();
      if (object.is_provisional) {
        DrawDashes(&area, line, colour, thickness);
      } else {
        cv::polylines(area, line, false, colour, thickness, cv::LINE_AA);
      }
    }
  }
  return all.empty() ? cv::Rect(layout.area.tl(), cv::Size(1, 1)) : cv::boundingRect(all);
}

void DrawOutlines(const RangeImage& image, const RangeImageLayout& layout,
                  const std::vector<DrawnObject>& outlines, cv::Mat* canvas) {
  for (const DrawnObject& outline : outlines)
    DrawBox(image, layout, outline, {{1, ToScalar(outline.colour)}}, canvas);
}

void DrawPoints(const RangeImage& image, const RangeImageLayout& layout,
                const std::vector<MarkedPoint>& points, cv::Mat* canvas) {
  cv::Mat area = (*canvas)(layout.area);
  for (const MarkedPoint& point : points) {
    if (point.p_sensor.norm() < 1e-3 || !CanHold(image.grid(), point.p_sensor)) continue;
    const cv::Point at =
        cv::Point(layout.ToCanvas(Project(image.grid(), point.p_sensor))) - layout.area.tl();
    const int radius = point.large ? 3 : 1;  // canvas pixels
    cv::circle(area, at, radius + 1, kDark, cv::FILLED);
    cv::circle(area, at, radius, ToScalar(point.colour), cv::FILLED);
  }
}

// Azimuths; of a pinhole image angles to the left of its axis.
void DrawAngles(const PixelGrid& grid, const RangeImageLayout& layout, cv::Mat* canvas) {
  constexpr double kRadPerDeg = M_PI / 180.0;
  const bool is_pinhole = grid.projection == Projection::kPinhole;
  const int most_deg = is_pinhole ? 70 : 360, step_deg = is_pinhole ? 10 : 30;
  int last_right = -1;
  for (int deg = most_deg; deg >= -most_deg; deg -= step_deg) {
    const double coordinate = is_pinhole ? std::tan(deg * kRadPerDeg) : deg * kRadPerDeg;
    const double column = (grid.left - coordinate) / grid.resolution;
    if (column < 0.0 || column > grid.width) continue;
    const int x = layout.area.x + static_cast<int>(column * layout.scale);
    cv::line(*canvas, {x, layout.area.br().y}, {x, layout.area.br().y + 5}, kTextColour, 1);
    const std::string text = (deg > 0 ? "+" : "") + std::to_string(deg);
    const cv::Size size = TextSize(text);
    const int left = std::clamp(x - size.width / 2, 0, canvas->cols - size.width);
    if (left <= last_right) continue;
    DrawText(canvas, text, {left, layout.area.br().y + 5}, kTextColour);
    last_right = left + size.width;
  }
}

// A filled patch with a text right of it; returns where the next one may begin.
template <typename ColourAt>
int DrawSwatch(cv::Mat* canvas, int x, int y, int width, const std::string& text,
               const ColourAt& colour_at) {
  constexpr int kHeight = 16;
  for (int dy = 0; dy < kHeight; ++dy)
    for (int dx = 0; dx < width; ++dx) canvas->at<Colour>(y + dy, x + dx) = colour_at(dx, dy);
  DrawText(canvas, text, {x + width + 2, y - 2}, kTextColour);
  return x + width + TextSize(text).width + 16;
}

std::string AnglesText(const PixelGrid& grid) {
  if (grid.projection == Projection::kSpherical) return "azimuth in degrees, left is +";
  constexpr double kDegPerRad = 180.0 / M_PI;
  char text[96];
  std::snprintf(text, sizeof(text),
                "pinhole: degrees left of its axis (azimuth %+.0f, elevation %+.0f)",
                grid.axis.azimuth * kDegPerRad, grid.axis.elevation * kDegPerRad);
  return text;
}

void DrawLegend(const RangeSpan& span, const PixelGrid& grid, const RangeImageLayout& layout,
                cv::Mat* canvas) {
  const int y = layout.canvas.height - kBorder - 18;
  constexpr int kBarWidth = 160;
  char near[32];
  char far[32];
  std::snprintf(near, sizeof(near), "%.1f m", span.near);
  std::snprintf(far, sizeof(far), "%.1f m and farther", span.far);
  DrawText(canvas, near, {kBorder, y - 2}, kTextColour);
  int x = kBorder + TextSize(near).width + 2;
  x = DrawSwatch(canvas, x, y, kBarWidth, far,
                 [](int dx, int) { return RangeColour(static_cast<double>(dx) / kBarWidth); });
  x = DrawSwatch(canvas, x, y, 24, "no return", [](int, int) { return NoReturnColour(); });
  x = DrawSwatch(canvas, x, y, 24, "never observed",
                 [](int dx, int dy) { return NeverObservedColour(dx, dy); });
  DrawText(canvas, AnglesText(grid), {x, y - 2}, kTextColour);
}

}  // namespace

RangeImageLayout LayOutRangeImage(const RangeImage& image, int target_width) {
  constexpr int kMaxScale = 8;
  RangeImageLayout layout;
  layout.scale = std::clamp(target_width / std::max(image.width(), 1), 1, kMaxScale);
  layout.area = cv::Rect(kBorder, kBorder + kTitleHeight, image.width() * layout.scale,
                         image.height() * layout.scale);
  layout.canvas = cv::Size(std::max(layout.area.width, kMinWidth) + 2 * kBorder,
                           layout.area.br().y + kFooterHeight);
  return layout;
}

cv::Mat DrawRangeImage(const RangeImage& image, const std::vector<DrawnObject>& objects,
                       const std::string& title, const PictureExtras& extras) {
  const RangeImageLayout layout = LayOutRangeImage(image, extras.range_image_width);
  cv::Mat canvas(layout.canvas, CV_8UC3, kBackground);
  DrawText(&canvas, title, {kBorder, kBorder}, kTextColour);
  if (image.grid().size() == 0) {
    DrawText(&canvas, "the range image is empty", {kBorder, kBorder + kTitleHeight}, kTextColour);
    return canvas;
  }
  const RangeSpan span = FindSpan(image);
  PaintPixels(image, layout, span, &canvas);
  const DepthBuffer scene = SceneDepth(image, layout);
  for (const DrawnObject& object : objects)
    if (object.model != nullptr) PaintSurface(image, layout, scene, object, &canvas);
  DrawOutlines(image, layout, extras.outlines, &canvas);
  DrawPoints(image, layout, extras.points, &canvas);

  LabelPlacer placer(layout.area);
  std::vector<cv::Rect> boxes;
  for (const DrawnObject& object : objects) {
    boxes.push_back(
        DrawBox(image, layout, object, {{4, kDark}, {2, ToScalar(object.colour)}}, &canvas));
    placer.AddObstacle(boxes.back());
  }
  for (std::size_t i = 0; i < objects.size(); ++i)
    DrawLabel(&canvas, &placer, objects[i].label, boxes[i], ToScalar(objects[i].colour));
  DrawAngles(image.grid(), layout, &canvas);
  DrawLegend(span, image.grid(), layout, &canvas);
  return canvas;
}

}  // namespace rimod
