#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

namespace rimod {

// Size of a text as DrawText draws it, with the margin round it, canvas pixels.
cv::Size TextSize(const std::string& text);

// Draws the text with its upper left corner (of the margin) at corner. Characters outside ASCII
// come out as '?'.
void DrawText(cv::Mat* canvas, const std::string& text, const cv::Point& corner,
              const cv::Scalar& colour);

// Finds places for labels: inside an area, near what they name, never on one another.
class LabelPlacer {
 public:
  explicit LabelPlacer(const cv::Rect& area) : area_(area) {}

  // Something that labels should rather not cover.
  void AddObstacle(const cv::Rect& obstacle) { obstacles_.push_back(obstacle); }
  // Something that labels must not cover.
  void AddBlocked(const cv::Rect& blocked) { labels_.push_back(blocked); }

  // The place of a label for what is drawn in target; nothing when there is no room within the
  // area. Places closest to the target come first.
  std::optional<cv::Rect> Place(const cv::Rect& target, const cv::Size& size);

 private:
  bool IsFree(const cv::Rect& place) const;
  int CoveredArea(const cv::Rect& place) const;

  cv::Rect area_;
  std::vector<cv::Rect> obstacles_;
  std::vector<cv::Rect> labels_;
};

// A label for what is drawn in target: dark plate, text in colour, and a line to the target when it
// stands apart from it. False when there was no room.
bool DrawLabel(cv::Mat* canvas, LabelPlacer* placer, const std::string& text,
               const cv::Rect& target, const cv::Scalar& colour);

}  // namespace rimod
