#include "viewer_tools/case_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "rimod/surface_rendering.h"
#include "viewer_tools/case_points.h"
#include "viewer_tools/labels.h"
#include "viewer_tools/range_colours.h"

namespace rimod {
namespace {

constexpr int kSide = kCasePictureSide;    // canvas pixels, of every picture in the row
constexpr int kGap = 10;                   // canvas pixels between them and round everything
constexpr int kLineHeight = 22;            // canvas pixels, of a line of text
constexpr std::size_t kNumCompared = 2;    // poses with a picture of depth differences
constexpr double kShownDifference = 0.20;  // m, at which the colours end
const cv::Scalar kBackground(32, 30, 28);
const cv::Scalar kTextColour(230, 230, 230);

// The pixels of the range image that a case shows.
struct Window {
  cv::Rect pixels;     // columns and rows; may reach beyond the image
  double scale = 1.0;  // canvas pixels a range image pixel
};

Window FindWindow(const std::vector<RenderedModel>& rendered) {
  cv::Rect all;
  for (const RenderedModel& r : rendered) {
    if (r.height <= 0 || r.width <= 0) continue;
    const cv::Rect rect(r.first_column, r.first_row, r.width, r.height);
    all = all.area() > 0 ? (all | rect) : rect;
  }
  constexpr int kMinMargin = 4;  // pixels
  const int margin = std::max(kMinMargin, std::max(all.width, all.height) / 5);
  const int side = std::max(all.width, all.height) + 2 * margin;
  const cv::Point centre = (all.tl() + all.br()) / 2;
  Window window;
  window.pixels = cv::Rect(centre.x - side / 2, centre.y - side / 2, side, side);
  window.scale = static_cast<double>(kSide) / side;
  return window;
}

// Calls function(x, y, row, column) for every pixel of a picture; the pixel of the range image that
// it shows may be outside.
template <typename Function>
void ForEachCanvasPixel(const Window& window, const Function& function) {
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      function(x, y, window.pixels.y + static_cast<int>(y / window.scale),
               window.pixels.x + static_cast<int>(x / window.scale));
}

bool IsRendered(const RenderedModel& rendered, int row, int column) {
  row -= rendered.first_row;
  column -= rendered.first_column;
  return row >= 0 && row < rendered.height && column >= 0 && column < rendered.width &&
         rendered.point(row, column) >= 0;
}

RangeSpan FindSpan(const RangeImage& image, const Window& window) {
  std::vector<float> ranges;
  const cv::Rect inside = window.pixels & cv::Rect(0, 0, image.width(), image.height());
  for (int row = inside.y; row < inside.br().y; ++row)
    for (int column = inside.x; column < inside.br().x; ++column)
      if (image.measured(row, column)) ranges.push_back(image.range(row, column));
  return SpanOf(std::move(ranges), 0.02, 0.05);
}

void DrawOutline(const RenderedModel& rendered, const Window& window, const Colour& colour,
                 cv::Mat* picture) {
  cv::Mat_<unsigned char> mask(kSide, kSide, static_cast<unsigned char>(0));
  ForEachCanvasPixel(window, [&](int x, int y, int row, int column) {
    if (IsRendered(rendered, row, column)) mask(y, x) = 255;
  });
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_LIST, cv::CHAIN_APPROX_SIMPLE);
  cv::drawContours(*picture, contours, -1, cv::Scalar(16, 16, 16), 3);
  cv::drawContours(*picture, contours, -1, ToScalar(colour), 1);
}

cv::Mat DrawOutlines(const RangeImage& image, const std::vector<CasePose>& poses,
                     const std::vector<RenderedModel>& rendered, const Window& window) {
  cv::Mat picture(kSide, kSide, CV_8UC3);
  const RangeSpan span = FindSpan(image, window);
  ForEachCanvasPixel(window, [&](int x, int y, int row, int column) {
    picture.at<Colour>(y, x) = PixelColour(image, row, column, span, x, y);
  });
  for (std::size_t i = poses.size(); i-- > 0;)
    DrawOutline(rendered[i], window, poses[i].colour, &picture);
  return picture;
}

cv::Mat DrawDifferences(const RangeImage& image, const RenderedModel& rendered,
                        const Colour& outline, const Window& window) {
  constexpr double kDimmed = 0.75;
  const Colour dark(28, 26, 24);
  cv::Mat picture(kSide, kSide, CV_8UC3);
  const RangeSpan span = FindSpan(image, window);
  ForEachCanvasPixel(window, [&](int x, int y, int row, int column) {
    Colour colour = PixelColour(image, row, column, span, x, y);
    if (!IsRendered(rendered, row, column)) {
      colour = Blend(colour, dark, kDimmed);
    } else if (image.grid().Contains(row, column) && image.measured(row, column)) {
      colour = DepthDifferenceColour(
          image.range(row, column) -
          rendered.range(row - rendered.first_row, column - rendered.first_column));
    }
    picture.at<Colour>(y, x) = colour;
  });
  DrawOutline(rendered, window, outline, &picture);
  return picture;
}

// A coloured patch and a text right of it; returns where the next one may begin.
int DrawSwatch(const Colour& colour, const std::string& text, const cv::Point& at,
               cv::Mat* canvas) {
  constexpr int kPatch = 14;  // canvas pixels
  cv::rectangle(*canvas, cv::Rect(at.x, at.y + 5, kPatch, 10), ToScalar(colour), cv::FILLED);
  DrawText(canvas, text, {at.x + kPatch, at.y}, kTextColour);
  return at.x + kPatch + TextSize(text).width + kGap;
}

// One line for the poses, one for the colours of depth differences.
void DrawLegend(const std::vector<CasePose>& poses, int y, cv::Mat* canvas) {
  int x = kGap;
  for (const CasePose& pose : poses)
    x = DrawSwatch(pose.colour, pose.model->name + ": " + pose.title, {x, y}, canvas);
  y += kLineHeight;
  x = kGap;
  const auto text = [&](const std::string& words) {
    DrawText(canvas, words, {x - 4, y}, kTextColour);
    x += TextSize(words).width;
  };
  text("measured minus model: 20 cm nearer (hidden)");
  constexpr int kBarWidth = 160;
  for (int dx = 0; dx < kBarWidth; ++dx)
    for (int dy = 0; dy < 12; ++dy)
      canvas->at<Colour>(y + 4 + dy, x + dx) =
          DepthDifferenceColour(kShownDifference * (2.0 * dx / kBarWidth - 1.0));
  x += kBarWidth + 6;
  text("20 cm farther (seen through)");
  DrawSwatch(NoReturnColour(), "no return", {x + kGap, y}, canvas);
}

}  // namespace

Colour DepthDifferenceColour(double difference) {
  const Colour nearer(200, 70, 20);
  const Colour equal(245, 245, 245);
  const Colour farther(30, 30, 205);
  const double share = std::clamp(difference / kShownDifference, -1.0, 1.0);
  return Blend(equal, share < 0.0 ? nearer : farther, std::sqrt(std::abs(share)));
}

cv::Mat DrawCase(const RangeImage& image, const std::vector<CasePose>& poses,
                 const std::string& title) {
  std::vector<RenderedModel> rendered;
  rendered.reserve(poses.size());
  for (const CasePose& pose : poses)
    rendered.push_back(RenderModel(
        *pose.model, image.T_local_sensor().inverse() * pose.T_local_object, image.grid()));
  std::vector<std::pair<std::string, cv::Mat>> pictures;
  if (!poses.empty()) {
    const Window window = FindWindow(rendered);
    pictures.emplace_back("range image", DrawOutlines(image, poses, rendered, window));
    for (std::size_t i = 0; i < std::min(kNumCompared, poses.size()); ++i)
      pictures.emplace_back("depth, " + poses[i].title,
                            DrawDifferences(image, rendered[i], poses[i].colour, window));
    const std::vector<cv::Mat> views = DrawCasePoints(image, poses);
    pictures.emplace_back("points from above", views[0]);
    pictures.emplace_back("from the side", views[1]);
  }
  constexpr int kNumPictures = 5;  // room for all, so that all cases are equally wide
  cv::Mat canvas(kSide + 4 * kLineHeight + 2 * kGap, kNumPictures * (kSide + kGap) + kGap, CV_8UC3,
                 kBackground);
  DrawText(&canvas, title, {kGap, kGap / 2}, kTextColour);
  int x = kGap;
  const int y = kGap + 2 * kLineHeight;
  for (const auto& [name, picture] : pictures) {
    DrawText(&canvas, name, {x - 4, y - kLineHeight}, kTextColour);
    picture.copyTo(canvas(cv::Rect(x, y, kSide, kSide)));
    x += kSide + kGap;
  }
  DrawLegend(poses, y + kSide + 3, &canvas);
  return canvas;
}

}  // namespace rimod
