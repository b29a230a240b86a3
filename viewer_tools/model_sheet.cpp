#include "viewer_tools/model_sheet.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "rimod/model_views.h"
#include "viewer_tools/labels.h"
#include "viewer_tools/palette.h"

namespace rimod {
namespace {

constexpr int kSide = 260;  // canvas pixels, of every picture
constexpr int kGap = 10;
constexpr int kLineHeight = 22;
constexpr int kColumns = 5;
constexpr int kMaxViews = 15;
const cv::Scalar kBackground(32, 30, 28);
const cv::Scalar kAreaColour(20, 19, 18);
const cv::Scalar kTextColour(230, 230, 230);
constexpr int kFeatureColour = 0;     // of ObjectColour: orange
constexpr int kValidationColour = 1;  // green
constexpr int kOutsideColour = 2;     // magenta

struct Tile {
  std::string title;
  cv::Mat picture;
};

// How the surface is looked at: canvas x along right, y against up.
struct Side {
  const char* title;
  Eigen::Vector3d right, up;
};

// Points as shaded dots, the nearest on top.
cv::Mat DrawSide(const ObjectModel& model, const Side& side, double pixels_per_metre) {
  cv::Mat picture(kSide, kSide, CV_8UC3, kAreaColour);
  cv::Mat_<float> depth(kSide, kSide, -std::numeric_limits<float>::infinity());
  const Eigen::Vector3d towards = side.right.cross(side.up);  // the viewer
  const Eigen::Vector3d centre = 0.5 * (model.box_min + model.box_max);
  const int size = std::clamp(cvRound(1.5 * model.point_spacing * pixels_per_metre), 1, 12);
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const Eigen::Vector3d p = model.points[i].cast<double>() - centre;
    const double facing = model.normals[i].cast<double>().dot(towards);
    if (facing < 0.0) continue;
    const auto nearness = static_cast<float>(p.dot(towards));
    const cv::Point corner(kSide / 2 + cvRound(p.dot(side.right) * pixels_per_metre) - size / 2,
                           kSide / 2 - cvRound(p.dot(side.up) * pixels_per_metre) - size / 2);
    const cv::Rect dot = cv::Rect(corner, cv::Size(size, size)) & cv::Rect(0, 0, kSide, kSide);
    for (int y = dot.y; y < dot.br().y; ++y) {
      for (int x = dot.x; x < dot.br().x; ++x) {
        if (nearness < depth(y, x)) continue;
        depth(y, x) = nearness;
        picture.at<Colour>(y, x) = HeightColour(facing);
      }
    }
  }
  const int bar = cvRound(0.1 * pixels_per_metre);
  cv::line(picture, {8, kSide - 10}, {8 + bar, kSide - 10}, kTextColour, 2);
  DrawText(&picture, "10 cm", {12 + bar, kSide - kLineHeight}, kTextColour);
  return picture;
}

std::vector<Tile> DrawSides(const ObjectModel& model) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const std::array<Side, kColumns> sides = {{{"front, from +x", y, z},
                                             {"left, from +y", -x, z},
                                             {"back, from -x", -y, z},
                                             {"right, from -y", x, z},
                                             {"above, x is up", -y, x}}};
  constexpr double kShare = 0.85;  // of the picture that the largest side takes
  const double extent = std::max((model.box_max - model.box_min).maxCoeff(), 1e-3);
  std::vector<Tile> tiles;
  for (const Side& side : sides)
    tiles.push_back({side.title, DrawSide(model, side, kShare * kSide / extent)});
  return tiles;
}

// The rectangle of the image in which something was measured, with a margin; square.
cv::Rect MeasuredWindow(const RangeImage& image) {
  cv::Rect window;
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column)
      if (image.measured(row, column)) {
        const cv::Rect pixel(column, row, 1, 1);
        window = window.area() > 0 ? (window | pixel) : pixel;
      }
  constexpr int kMargin = 4;  // pixels
  const int side = std::max(window.width, window.height) + 2 * kMargin;
  const cv::Point centre = (window.tl() + window.br()) / 2;
  return {centre.x - side / 2, centre.y - side / 2, side, side};
}

Colour ViewColour(const RangeImage& image, int row, int column, double nearest, double farthest) {
  if (!image.grid().Contains(row, column) || !image.measured(row, column)) return {20, 19, 18};
  return RangeColour(0.7 * (image.range(row, column) - nearest) / (farthest - nearest));
}

Tile DrawView(const ObjectModel& model, const ModelView& view, double resolution) {
  const RangeImage image = RenderView(model, view.viewpoint, resolution, 0.0);
  const cv::Rect window = MeasuredWindow(image);
  const double scale = static_cast<double>(kSide) / window.width;
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = 0.0;
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column)
      if (image.measured(row, column)) {
        nearest = std::min<double>(nearest, image.range(row, column));
        farthest = std::max<double>(farthest, image.range(row, column));
      }
  farthest = std::max(farthest, nearest + 0.05);
  cv::Mat picture(kSide, kSide, CV_8UC3);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      picture.at<Colour>(y, x) =
          ViewColour(image, window.y + static_cast<int>(y / scale),
                     window.x + static_cast<int>(x / scale), nearest, farthest);
  const Eigen::Isometry3d T_sensor_object = image.T_local_sensor().inverse();
  const auto mark = [&](const Eigen::Vector3f& point, int radius, int colour) {
    const PixelPosition at = Project(image.grid(), T_sensor_object * point.cast<double>());
    const cv::Point centre(cvRound((at.column - window.x) * scale),
                           cvRound((at.row - window.y) * scale));
    cv::circle(picture, centre, radius + 1, cv::Scalar(16, 16, 16), cv::FILLED);
    cv::circle(picture, centre, radius, ToScalar(ObjectColour(colour)), cv::FILLED);
  };
  for (const Feature& feature : view.features) mark(feature.position, 2, kFeatureColour);
  for (const Eigen::Vector3f& point : view.outside_points) mark(point, 1, kOutsideColour);
  for (const Eigen::Vector3f& point : view.validation_points) mark(point, 1, kValidationColour);
  const Eigen::Vector3d line =
      view.viewpoint - Eigen::Vector3d(0.5 * (model.box_min + model.box_max));
  constexpr double kDegPerRad = 180.0 / M_PI;
  return {
      fmt::format("az {:.0f}, el {:.0f}: {} features", std::atan2(line.y(), line.x()) * kDegPerRad,
                  std::atan2(line.z(), line.head<2>().norm()) * kDegPerRad, view.features.size()),
      picture};
}

std::vector<Tile> DrawViews(const ObjectModel& model, double resolution) {
  std::vector<Tile> tiles;
  const int count = static_cast<int>(model.views.size());
  const int shown = std::min(count, kMaxViews);
  for (int k = 0; k < shown; ++k)
    tiles.push_back(DrawView(model, model.views[k * count / shown], resolution));
  return tiles;
}

std::vector<std::string> Words(const ObjectModel& model) {
  std::size_t num_features = 0;
  for (const ModelView& view : model.views) num_features += view.features.size();
  const Eigen::Vector3d size = model.box_max - model.box_min;
  return {fmt::format("{}, from {}", model.name, model.source),
          fmt::format("box {:.3f} x {:.3f} x {:.3f} m; {} points, {:.0f} mm apart; {} views, {} "
                      "features",
                      size.x(), size.y(), size.z(), model.points.size(),
                      1000.0 * model.point_spacing, model.views.size(), num_features)};
}

void DrawLegend(int y, cv::Mat* canvas) {
  int x = kGap;
  for (const auto& [colour, words] :
       {std::pair(kFeatureColour, "feature"), std::pair(kValidationColour, "validation point"),
        std::pair(kOutsideColour, "outside point")}) {
    cv::circle(*canvas, {x + 5, y + 10}, 4, ToScalar(ObjectColour(colour)), cv::FILLED);
    DrawText(canvas, words, {x + 12, y}, kTextColour);
    x += 12 + TextSize(words).width + kGap;
  }
  DrawText(canvas, "range: near light, far dark; az, el: where a view is taken from, degrees",
           {x, y}, kTextColour);
}

}  // namespace

cv::Mat DrawModelSheet(const ObjectModel& model, double resolution) {
  std::vector<Tile> tiles;
  if (!model.points.empty()) tiles = DrawSides(model);
  if (!model.points.empty())
    for (Tile& tile : DrawViews(model, resolution)) tiles.push_back(std::move(tile));
  const int num_rows = static_cast<int>(tiles.size() + kColumns - 1) / kColumns;
  constexpr int kRowHeight = kSide + kLineHeight + kGap;
  constexpr int kHead = 3 * kLineHeight + kGap;
  cv::Mat canvas(kHead + std::max(num_rows, 1) * kRowHeight, kColumns * (kSide + kGap) + kGap,
                 CV_8UC3, kBackground);
  int y = kGap / 2;
  for (const std::string& words : Words(model)) {
    DrawText(&canvas, words, {kGap - 4, y}, kTextColour);
    y += kLineHeight;
  }
  DrawLegend(y, &canvas);
  if (tiles.empty()) DrawText(&canvas, "the model has no points", {kGap, kHead}, kTextColour);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const cv::Point corner(kGap + static_cast<int>(i % kColumns) * (kSide + kGap),
                           kHead + static_cast<int>(i / kColumns) * kRowHeight);
    DrawText(&canvas, tiles[i].title, corner - cv::Point(4, 0), kTextColour);
    tiles[i].picture.copyTo(
        canvas(cv::Rect(corner + cv::Point(0, kLineHeight), cv::Size(kSide, kSide))));
  }
  return canvas;
}

}  // namespace rimod
