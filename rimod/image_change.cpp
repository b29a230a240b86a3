#include "rimod/image_change.h"

#include <algorithm>
#include <cmath>

#include "rimod/fast_atan2.h"

namespace rimod {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kFar = 1e6f;  // pixels

// A number of pixels; nothing when it is not whole.
bool WholePixels(double pixels, int* whole) {
  constexpr double kRounding = 1e-6;
  constexpr double kMost = 1e6;
  if (!(std::abs(pixels) < kMost)) return false;
  *whole = static_cast<int>(std::lround(pixels));
  return std::abs(pixels - *whole) < kRounding;
}

bool IsSamePixel(const RangeImage& a, int row_a, int column_a, const RangeImage& b, int row_b,
                 int column_b) {
  const Pixel pixel = a.pixel(row_a, column_a);
  if (pixel != b.pixel(row_b, column_b)) return false;
  if (pixel != Pixel::kMeasured) return true;
  const RoundedPixel first = a.rounded(row_a, column_a), second = b.rounded(row_b, column_b);
  return first.range == second.range && first.offset_azimuth == second.offset_azimuth &&
         first.offset_elevation == second.offset_elevation;
}

}  // namespace

ImageChange::ImageChange(const RangeImage& before, const RangeImage& now)
    : grid_(now.grid()), width_before_(before.width()) {
  const SphericalGrid& old = before.grid();
  const bool comparable =
      old.size() > 0 && grid_.size() > 0 && old.resolution == grid_.resolution &&
      before.T_local_sensor().matrix() == now.T_local_sensor().matrix() &&
      WholePixels((grid_.elevation_top - old.elevation_top) / grid_.resolution, &row_shift_) &&
      WholePixels((grid_.azimuth_left - old.azimuth_left) / grid_.resolution, &column_shift_);
  if (!comparable) return;
  everything_ = false;
  const std::size_t stride = static_cast<std::size_t>(grid_.width) + 1;
  changed_before_.assign(stride * (static_cast<std::size_t>(grid_.height) + 1), 0);
  for (int row = 0; row < grid_.height; ++row) {
    int in_row = 0;
    for (int column = 0; column < grid_.width; ++column) {
      const int old_row = row - row_shift_, old_column = column - column_shift_;
      const bool same = old.Contains(old_row, old_column)
                            ? IsSamePixel(before, old_row, old_column, now, row, column)
                            : now.pixel(row, column) == Pixel::kNeverObserved;
      in_row += same ? 0 : 1;
      const std::size_t below = (static_cast<std::size_t>(row) + 1) * stride + column + 1;
      changed_before_[below] = changed_before_[below - stride] + in_row;
    }
  }
}

int ImageChange::CountChanged(int first_row, int last_row, int first_column,
                              int last_column) const {
  first_row = std::max(first_row, 0);
  first_column = std::max(first_column, 0);
  last_row = std::min(last_row, grid_.height - 1);
  last_column = std::min(last_column, grid_.width - 1);
  if (first_row > last_row || first_column > last_column) return 0;
  const int stride = grid_.width + 1;
  const int* const above = changed_before_.data() + first_row * stride;
  const int* const below = changed_before_.data() + (last_row + 1) * stride;
  return below[last_column + 1] - below[first_column] - above[last_column + 1] +
         above[first_column];
}

bool ImageChange::TouchesPixels(int row, int column, int reach) const {
  return everything_ || CountChanged(row - reach, row + reach, column - reach, column + reach) > 0;
}

bool ImageChange::Touches(const Eigen::Vector3f& centre, float radius) const {
  if (everything_) return true;
  const double distance = centre.norm();
  if (!(distance > radius)) return true;  // around the sensor, or not a number
  const Direction middle = DirectionOf(centre.cast<double>());
  const double angle = std::asin(radius / distance);
  const PixelPosition at = ProjectDirection(grid_, middle);
  const double rows = angle / grid_.resolution;
  // Meridians converge towards the poles; a sphere over one is all around, and so is one behind.
  double half_width = kPi;
  if (std::abs(middle.elevation) + angle < 0.5 * kPi)
    half_width = std::asin(std::min(std::sin(angle) / std::cos(middle.elevation), 1.0));
  const bool all_around = std::abs(middle.azimuth) + half_width >= kPi;
  const double columns = half_width / grid_.resolution;
  const int first_column = all_around ? 0 : static_cast<int>(std::floor(at.column - columns));
  const int last_column =
      all_around ? grid_.width - 1 : static_cast<int>(std::floor(at.column + columns));
  return CountChanged(static_cast<int>(std::floor(at.row - rows)),
                      static_cast<int>(std::floor(at.row + rows)), first_column, last_column) > 0;
}

bool ImageChange::TouchesBox(const Eigen::Isometry3f& T_sensor_object, const Eigen::Vector3f& low,
                             const Eigen::Vector3f& high) const {
  if (everything_ || !T_sensor_object.matrix().allFinite()) return true;
  const float left = static_cast<float>(grid_.azimuth_left);
  const float top = static_cast<float>(grid_.elevation_top);
  const float per_radian = static_cast<float>(1.0 / grid_.resolution);
  float first_row = kFar, last_row = -kFar, first_column = kFar, last_column = -kFar;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f p = T_sensor_object * Eigen::Vector3f((corner & 1 ? high : low).x(),
                                                                (corner & 2 ? high : low).y(),
                                                                (corner & 4 ? high : low).z());
    const float row = (top - FastAtan2(p.z(), p.head<2>().norm())) * per_radian;
    const float column = (left - FastAtan2(p.y(), p.x())) * per_radian;
    first_row = std::min(first_row, row);
    last_row = std::max(last_row, row);
    first_column = std::min(first_column, column);
    last_column = std::max(last_column, column);
  }
  // Half around and more: behind the sensor, where azimuths begin again, or about it.
  if (last_column - first_column >= static_cast<float>(kPi) * per_radian) return true;
  return CountChanged(static_cast<int>(std::floor(first_row)),
                      static_cast<int>(std::floor(last_row)),
                      static_cast<int>(std::floor(first_column)),
                      static_cast<int>(std::floor(last_column))) > 0;
}

std::vector<PixelRun> ImageChange::MovedRuns(const std::vector<PixelRun>& runs) const {
  std::vector<PixelRun> moved;
  if (everything_) return moved;
  for (const PixelRun& run : runs) {
    for (int pixel = run.first; pixel < run.first + run.count; ++pixel) {
      const int row = pixel / width_before_ + row_shift_;
      const int column = pixel % width_before_ + column_shift_;
      if (!grid_.Contains(row, column)) continue;
      const int index = row * grid_.width + column;
      if (!moved.empty() && moved.back().first + moved.back().count == index) {
        ++moved.back().count;
      } else {
        moved.push_back({index, 1});
      }
    }
  }
  return moved;
}

}  // namespace rimod
