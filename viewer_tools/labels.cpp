#include "viewer_tools/labels.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

namespace rimod {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontScale = 0.5;
constexpr int kMargin = 4;  // canvas pixels round a text

// The eight places round a target, at a distance, those above and below first.
std::array<cv::Point, 8> CornersAround(const cv::Rect& target, const cv::Size& size, int distance) {
  const int left = target.x - distance - size.width;
  const int right = target.br().x + distance;
  const int above = target.y - distance - size.height;
  const int below = target.br().y + distance;
  const int centre_x = target.x + (target.width - size.width) / 2;
  const int centre_y = target.y + (target.height - size.height) / 2;
  return {{{centre_x, above},
           {centre_x, below},
           {right, centre_y},
           {left, centre_y},
           {right, above},
           {left, above},
           {right, below},
           {left, below}}};
}

cv::Point ClosestPoint(const cv::Rect& rect, const cv::Point& point) {
  return {std::clamp(point.x, rect.x, rect.br().x - 1),
          std::clamp(point.y, rect.y, rect.br().y - 1)};
}

// The corner nearest to the given one from which the size fits into the area, if it does at all.
cv::Point ShiftedInto(const cv::Rect& area, const cv::Point& corner, const cv::Size& size) {
  return {std::max(area.x, std::min(corner.x, area.br().x - size.width)),
          std::max(area.y, std::min(corner.y, area.br().y - size.height))};
}

}  // namespace

cv::Size TextSize(const std::string& text) {
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, kFont, kFontScale, 1, &baseline);
  return {size.width + 2 * kMargin, size.height + baseline + 2 * kMargin};
}

void DrawText(cv::Mat* canvas, const std::string& text, const cv::Point& corner,
              const cv::Scalar& colour) {
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, kFont, kFontScale, 1, &baseline);
  const cv::Point origin(corner.x + kMargin, corner.y + kMargin + size.height);
  cv::putText(*canvas, text, origin, kFont, kFontScale, colour, 1, cv::LINE_AA);
}

bool LabelPlacer::IsFree(const cv::Rect& place) const {
  if ((place & area_) != place) return false;
  return std::none_of(labels_.begin(), labels_.end(),
                      [&](const cv::Rect& label) { return (label & place).area() > 0; });
}

int LabelPlacer::CoveredArea(const cv::Rect& place) const {
  int covered = 0;
  for (const cv::Rect& obstacle : obstacles_) covered += (obstacle & place).area();
  return covered;
}

std::optional<cv::Rect> LabelPlacer::Place(const cv::Rect& target, const cv::Size& size) {
  const cv::Rect visible = target & area_;
  const cv::Rect anchor = visible.area() > 0 ? visible
                                             : cv::Rect(ClosestPoint(area_, target.tl()),
                                                        cv::Size(1, 1));  // points towards it
  std::optional<cv::Rect> best;
  long long best_cost = 0;
  const int reach = std::max(area_.width, area_.height);
  for (int distance = 3; distance < reach; distance += 8) {
    for (const cv::Point& corner : CornersAround(anchor, size, distance)) {
      const cv::Rect place(ShiftedInto(area_, corner, size), size);
      if (!IsFree(place)) continue;
      // A label may move by its own height to uncover what it would hide.
      const long long cost = CoveredArea(place) + static_cast<long long>(distance) * size.width / 2;
      if (!best || cost < best_cost) {
        best = place;
        best_cost = cost;
      }
    }
    if (best && best_cost < static_cast<long long>(distance) * size.width / 2) break;
  }
  if (best) labels_.push_back(*best);
  return best;
}

bool DrawLabel(cv::Mat* canvas, LabelPlacer* placer, const std::string& text,
               const cv::Rect& target, const cv::Scalar& colour) {
  const std::optional<cv::Rect> place = placer->Place(target, TextSize(text));
  if (!place) return false;
  constexpr int kTouching = 12;  // canvas pixels: closer needs no line
  const cv::Point centre = (place->tl() + place->br()) / 2;
  const cv::Point on_target = ClosestPoint(target, centre);
  const cv::Point on_label = ClosestPoint(*place, on_target);
  if (cv::norm(on_target - on_label) > kTouching)
    cv::line(*canvas, on_label, on_target, colour, 1, cv::LINE_AA);
  cv::rectangle(*canvas, *place, cv::Scalar(16, 16, 16), cv::FILLED);
  cv::rectangle(*canvas, *place, colour, 1);
  DrawText(canvas, text, place->tl(), colour);
  return true;
}

}  // namespace rimod
