#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "rimod/interest_points.h"
#include "rimod/range_image.h"

namespace rimod {

// Pixels looked at across; wider neighbourhoods are thinned.
constexpr int kMaxNeighbourhoodSide = 31;

// How far around a pixel to look for the points within radius of its own, at range (m).
inline PixelReach NeighbourhoodReach(const PixelGrid& grid, const PixelIndex& pixel, double radius,
                                     double range) {
  const ImageCoordinates at = CoordinatesAt(grid, pixel.row + 0.5, pixel.column + 0.5);
  if (grid.projection == Projection::kPinhole) return PinholeReach(grid, at, radius / range);
  const double angle = radius < range ? std::asin(radius / range) : 1.5;
  const double widening = 1.0 / std::max(std::cos(at.up), 0.2);  // meridians converge upwards
  return {angle / grid.resolution, angle * widening / grid.resolution};
}

// Calls visit(point, step) for the measured points within radius (m) of the pixel's own, which is
// among them; the pixel must be measured. Thinned to every step-th row and column, at most
// kMaxNeighbourhoodSide^2 pixels.
template <typename Visitor>
void VisitNeighbourhood(const RangeImage& image, const PixelIndex& pixel, double radius,
                        const Visitor& visit) {
  const Eigen::Vector3f& centre = image.point(pixel.row, pixel.column);
  const double range = image.range(pixel.row, pixel.column);
  const PixelReach reach = NeighbourhoodReach(image.grid(), pixel, radius, range);
  const int reach_rows = static_cast<int>(std::ceil(reach.rows));
  const int reach_columns = static_cast<int>(std::ceil(reach.columns));
  const int step = 1 + 2 * std::max(reach_rows, reach_columns) / kMaxNeighbourhoodSide;
  const float radius_sq = static_cast<float>(radius * radius);
  for (int dr = -(reach_rows / step) * step; dr <= reach_rows; dr += step) {
    const int row = pixel.row + dr;
    if (row < 0 || row >= image.height()) continue;
    for (int dc = -(reach_columns / step) * step; dc <= reach_columns; dc += step) {
      const int column = pixel.column + dc;
      if (column < 0 || column >= image.width() || !image.measured(row, column)) continue;
      const Eigen::Vector3f& point = image.point(row, column);
      if ((point - centre).squaredNorm() <= radius_sq) visit(point, step);
    }
  }
}

}  // namespace rimod
