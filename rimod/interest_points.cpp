#include "rimod/interest_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "rimod/check.h"

namespace rimod {
namespace {

struct Candidate {
  float strength = 0.0f;
  int index = 0;  // row * width + column
};

constexpr float kFarAway = 1000.0f;  // m, grey value of "no return"; differences to it are clipped

// Ranges as a grey image. Pixels never observed take the mean of their measured neighbours, or else
// the value before them in reading order, so that holes are no corners.
cv::Mat GreyImage(const RangeImage& image) {
  cv::Mat grey(image.height(), image.width(), CV_32F, cv::Scalar(0));
  for (int row = 0; row < image.height(); ++row) {
    float last = 0.0f;
    for (int column = 0; column < image.width(); ++column) {
      float sum = image.range(row, column);
      int count = sum > 0.0f ? 1 : 0;
      if (count == 0) {
        for (int r = std::max(row - 1, 0); r <= std::min(row + 1, image.height() - 1); ++r) {
          for (int c = std::max(column - 1, 0); c <= std::min(column + 1, image.width() - 1); ++c) {
            if (!image.measured(r, c)) continue;
            sum += image.range(r, c);
            ++count;
          }
        }
      }
      if (count > 0) last = sum / static_cast<float>(count);
      if (image.pixel(row, column) == Pixel::kNoReturn) last = kFarAway;
      grey.at<float>(row, column) = last;
    }
  }
  return grey;
}

// Differences to the neighbours, large ones clipped: otherwise only depth jumps would be corners.
void Gradients(const cv::Mat& grey, float max_jump, cv::Mat* dx, cv::Mat* dy) {
  dx->create(grey.size(), CV_32F);
  dy->create(grey.size(), CV_32F);
  for (int row = 0; row < grey.rows; ++row) {
    for (int column = 0; column < grey.cols; ++column) {
      const float right = grey.at<float>(row, std::min(column + 1, grey.cols - 1));
      const float left = grey.at<float>(row, std::max(column - 1, 0));
      const float below = grey.at<float>(std::min(row + 1, grey.rows - 1), column);
      const float above = grey.at<float>(std::max(row - 1, 0), column);
      dx->at<float>(row, column) = std::clamp(right - left, -max_jump, max_jump);
      dy->at<float>(row, column) = std::clamp(below - above, -max_jump, max_jump);
    }
  }
}

// Harris and Stephens: det(M) - k * trace(M)^2 of the summed gradient products M.
cv::Mat HarrisStrength(const RangeImage& image, const InterestPointParams& params) {
  cv::Mat dx, dy;
  Gradients(GreyImage(image), static_cast<float>(params.max_depth_jump), &dx, &dy);
  const cv::Size window(params.harris_window, params.harris_window);
  cv::Mat xx, yy, xy;
  cv::boxFilter(dx.mul(dx), xx, CV_32F, window, cv::Point(-1, -1), true, cv::BORDER_REPLICATE);
  cv::boxFilter(dy.mul(dy), yy, CV_32F, window, cv::Point(-1, -1), true, cv::BORDER_REPLICATE);
  cv::boxFilter(dx.mul(dy), xy, CV_32F, window, cv::Point(-1, -1), true, cv::BORDER_REPLICATE);
  const cv::Mat trace = xx + yy;
  return xx.mul(yy) - xy.mul(xy) - params.harris_k * trace.mul(trace);
}

// How sharply the surface bends at b on the way from a to c: 0 straight .. 1 turned back.
float Bend(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const Eigen::Vector3f first = b - a, second = c - b;
  const float norms = first.norm() * second.norm();
  return norms > 0.0f ? 0.5f * (1.0f - first.dot(second) / norms) : 0.0f;
}

// Whether the surface ends between a range and the next one on a line; on a slope (a floor far
// away) they grow further as they did from the one before, 0 when that is not measured.
bool FallsOff(float before, float range, float after, float jump) {
  constexpr float kSlopesGrow = 1.3f;
  const float rise = before > 0.0f ? std::max(range - before, 0.0f) : 0.0f;
  return after > range + jump + kSlopesGrow * rise;
}

// Strongest bend of the surface through a pixel over its four lines; 1 on the near side of a jump.
// Lines on which something nearer stands say nothing: the surface goes on behind it.
float SurfaceChangeAt(const RangeImage& image, int row, int column,
                      const InterestPointParams& params) {
  const float range = image.range(row, column);
  const int step =
      std::clamp(static_cast<int>(std::lround(params.bend_step /
                                              (PixelAngle(image.grid(), row, column) * range))),
                 1, 20);
  constexpr std::array<PixelIndex, 4> kLines = {{{0, 1}, {1, 0}, {1, 1}, {1, -1}}};
  const float jump = static_cast<float>(params.max_depth_jump);
  float strength = 0.0f;
  bool near_side = false;
  for (const PixelIndex& line : kLines) {
    const int dr = line.row * step, dc = line.column * step;
    if (!image.grid().Contains(row - dr, column - dc) ||
        !image.grid().Contains(row + dr, column + dc))
      continue;
    const float before = image.range(row - dr, column - dc);
    const float after = image.range(row + dr, column + dc);
    const bool shadowed =
        (before > 0.0f && before < range - jump) || (after > 0.0f && after < range - jump);
    if (shadowed) continue;
    const bool open_before = image.pixel(row - dr, column - dc) == Pixel::kNoReturn ||
                             FallsOff(after, range, before, jump);
    const bool open_after = image.pixel(row + dr, column + dc) == Pixel::kNoReturn ||
                            FallsOff(before, range, after, jump);
    near_side = near_side || open_before || open_after;
    if (before <= 0.0f || after <= 0.0f || open_before || open_after) continue;
    strength = std::max(strength, Bend(image.point(row - dr, column - dc), image.point(row, column),
                                       image.point(row + dr, column + dc)));
  }
  return near_side ? 1.0f : strength;
}

cv::Mat SurfaceChange(const RangeImage& image, const InterestPointParams& params,
                      const Execution& execution) {
  cv::Mat strength(image.height(), image.width(), CV_32F, cv::Scalar(0));
  execution.parallel_for(static_cast<std::size_t>(image.height()), [&](std::size_t i) {
    const int row = static_cast<int>(i);
    for (int column = 0; column < image.width(); ++column) {
      if (!image.measured(row, column)) continue;
      strength.at<float>(row, column) = SurfaceChangeAt(image, row, column, params);
    }
  });
  cv::Mat smooth;
  cv::boxFilter(strength, smooth, CV_32F, cv::Size(3, 3), cv::Point(-1, -1), true,
                cv::BORDER_REPLICATE);
  return strength.mul(smooth);
}

// Orders by strength, ties by position in the image.
bool Weaker(const Candidate& a, const Candidate& b) {
  return a.strength != b.strength ? a.strength < b.strength : a.index > b.index;
}

// A heap, the strongest on top: most points are chosen before an eighth of it has been looked at.
std::vector<Candidate> CandidateHeap(const RangeImage& image, const cv::Mat& strength,
                                     const InterestPointParams& params) {
  std::vector<Candidate> candidates;
  for (int row = 0; row < image.height(); ++row) {
    for (int column = 0; column < image.width(); ++column) {
      const float value = strength.at<float>(row, column);
      if (!image.measured(row, column) || image.range(row, column) > params.max_range) continue;
      if (value > params.min_strength) candidates.push_back({value, row * image.width() + column});
    }
  }
  std::make_heap(candidates.begin(), candidates.end(), Weaker);
  return candidates;
}

// Counts points in the cubes of space, so that crowded places leave some to the others.
class CubeCounter {
 public:
  CubeCounter(double side, int most) : side_(static_cast<float>(side)), most_(most) {}

  // Whether the point's cube has room for it; takes it.
  bool Take(const Eigen::Vector3f& point) {
    if (most_ == 0) return true;
    const Eigen::Vector3i cube = (point / side_).array().floor().cast<int>();
    int& count = counts_[{cube.x(), cube.y(), cube.z()}];
    if (count == most_) return false;
    ++count;
    return true;
  }

 private:
  float side_;  // m
  int most_;
  std::map<std::array<int, 3>, int> counts_;
};

// As far as there may be points within the radius of the chosen pixel's.
PixelReach SuppressionReach(const RangeImage& image, const PixelIndex& chosen, double radius) {
  const PixelGrid& grid = image.grid();
  const Eigen::Vector3d centre = image.point(chosen.row, chosen.column).cast<double>();
  const double sine = std::min(radius / image.range(chosen.row, chosen.column), 1.0);
  if (grid.projection == Projection::kPinhole)
    return PinholeReach(grid, CoordinatesAt(grid, chosen.row + 0.5, chosen.column + 0.5), sine);
  const double widened = sine / std::max(std::cos(DirectionOf(centre).elevation), 1e-3);
  return {std::asin(sine) / grid.resolution,
          std::asin(std::min(widened, 1.0)) / grid.resolution};  // meridians converge
}

// Marks the pixels around a chosen one whose points lie within the suppression radius.
void Suppress(const RangeImage& image, const PixelIndex& chosen, double radius,
              std::vector<char>* suppressed) {
  const Eigen::Vector3f& centre = image.point(chosen.row, chosen.column);
  constexpr int kMostPixels = 60;
  const PixelReach reach = SuppressionReach(image, chosen, radius);
  const int rows = std::min(static_cast<int>(reach.rows) + 1, kMostPixels);
  const int columns = std::min(static_cast<int>(reach.columns) + 1, kMostPixels);
  const float radius_sq = static_cast<float>(radius * radius);
  for (int r = std::max(chosen.row - rows, 0); r <= std::min(chosen.row + rows, image.height() - 1);
       ++r) {
    for (int c = std::max(chosen.column - columns, 0);
         c <= std::min(chosen.column + columns, image.width() - 1); ++c) {
      if (image.measured(r, c) && (image.point(r, c) - centre).squaredNorm() < radius_sq)
        (*suppressed)[r * image.width() + c] = 1;
    }
  }
}

}  // namespace

void InterestPointParams::Validate() const {
  CheckWithin("interest_points max_points", max_points, 1, 1'000'000);
  CheckWithin("interest_points harris_window", harris_window, 2, 15);
  CheckWithin("interest_points harris_k", harris_k, 0.0, 0.25);
  CheckWithin("interest_points max_depth_jump", max_depth_jump, 1e-3, 100.0);
  CheckWithin("interest_points bend_step", bend_step, 1e-3, 1.0);
  CheckWithin("interest_points min_strength", min_strength, 0.0, 1e9);
  CheckWithin("interest_points suppression_radius", suppression_radius, 0.0, 10.0);
  CheckWithin("interest_points cube_side", cube_side, 0.01, 100.0);
  CheckWithin("interest_points max_points_a_cube", max_points_a_cube, 0, 1'000'000);
  CheckWithin("interest_points max_range", max_range, 0.1, 1000.0);
}

std::string InterestPointParams::Kind() const {
  std::ostringstream kind;
  kind << (measure == InterestMeasure::kHarris ? "harris" : "surface_change") << ' ' << max_points
       << ' ' << harris_window << ' ' << harris_k << ' ' << max_depth_jump << ' ' << bend_step
       << ' ' << min_strength << ' ' << suppression_radius << ' ' << cube_side << ' '
       << max_points_a_cube << ' ' << max_range;
  return kind.str();
}

std::vector<PixelIndex> FindInterestPoints(const RangeImage& image,
                                           const InterestPointParams& params,
                                           const Execution& execution) {
  params.Validate();
  if (image.grid().size() == 0) return {};
  const cv::Mat strength = params.measure == InterestMeasure::kHarris
                               ? HarrisStrength(image, params)
                               : SurfaceChange(image, params, execution);
  std::vector<char> suppressed(image.grid().size(), 0);
  std::vector<PixelIndex> chosen;
  CubeCounter cubes(params.cube_side, params.max_points_a_cube);
  std::vector<Candidate> candidates = CandidateHeap(image, strength, params);
  while (!candidates.empty()) {
    std::pop_heap(candidates.begin(), candidates.end(), Weaker);
    const Candidate candidate = candidates.back();
    candidates.pop_back();
    if (suppressed[candidate.index]) continue;
    const PixelIndex pixel = {candidate.index / image.width(), candidate.index % image.width()};
    if (!cubes.Take(image.point(pixel.row, pixel.column))) continue;
    chosen.push_back(pixel);
    if (static_cast<int>(chosen.size()) == params.max_points) break;
    Suppress(image, chosen.back(), params.suppression_radius, &suppressed);
  }
  return chosen;
}

}  // namespace rimod
