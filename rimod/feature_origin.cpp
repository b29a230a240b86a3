#include "rimod/feature_origin.h"

#include <algorithm>
#include <cmath>

namespace rimod {
namespace {

constexpr double kPi = 3.14159265358979323846;

// m, and of the range: some units of a float's last place, far less than a step of the rounding.
constexpr float kTolerance = 2e-6f;

bool IsPointOf(const RangeImage& image, int row, int column, const Eigen::Vector3f& position) {
  if (!image.grid().Contains(row, column) || !image.measured(row, column)) return false;
  const float tolerance = kTolerance * (1.0f + image.range(row, column));
  return (image.point(row, column) - position).cwiseAbs().maxCoeff() <= tolerance;
}

// The pixel, or one beside it: a point may lie on its pixel's edge.
bool IsPointNear(const RangeImage& image, const PixelPosition& pixel,
                 const Eigen::Vector3f& position) {
  if (!(pixel.row >= -1.0 && pixel.row <= image.height() + 1.0 && pixel.column >= -1.0 &&
        pixel.column <= image.width() + 1.0)) {
    return false;
  }
  const int row = static_cast<int>(std::floor(pixel.row));
  const int column = static_cast<int>(std::floor(pixel.column));
  if (IsPointOf(image, row, column, position)) return true;
  for (int dr = -1; dr <= 1; ++dr)
    for (int dc = -1; dc <= 1; ++dc)
      if (IsPointOf(image, row + dr, column + dc, position)) return true;
  return false;
}

}  // namespace

bool AreFeaturesOf(const RangeImage& image, const FeatureSet& features) {
  return std::all_of(features.features.begin(), features.features.end(),
                     [&image](const Feature& feature) {
                       Direction direction = DirectionOf(feature.position.cast<double>());
                       // The grid may go on past straight behind, where the azimuth's sign changes.
                       for (const double turn : {0.0, 2.0 * kPi, -4.0 * kPi}) {
                         direction.azimuth += turn;
                         const PixelPosition pixel = ProjectDirection(image.grid(), direction);
                         if (IsPointNear(image, pixel, feature.position)) return true;
                       }
                       return false;
                     });
}

}  // namespace rimod
