#include "rimod/image_change.h"

#include <algorithm>
#include <cmath>

#include "rimod/fast_atan2.h"

namespace rimod {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kFar = 1e6f;  // beyond all image coordinates

// A number of pixels; nothing when it is not whole.
bool WholePixels(double pixels, int* whole) {
  constexpr double kRounding = 1e-6;
  constexpr double kMost = 1e6;
  if (!(std::abs(pixels) < kMost)) return false;
  *whole = static_cast<int>(std::lround(pixels));
  return std::abs(pixels - *whole) < kRounding;
}

// Whether grids lay out directions alike, wherever their edges are.
bool IsSamePlane(const PixelGrid& a, const PixelGrid& b) {
  return a.resolution == b.resolution && a.projection == b.projection &&
         a.axis.azimuth == b.axis.azimuth && a.axis.elevation == b.axis.elevation;
}

bool IsSamePixel(const RangeImage& a, int row_a, int column_a, const RangeImage& b, int row_b,
                 int column_b) {
  const Pixel pixel = a.pixel(row_a, column_a);
  if (pixel != b.pixel(row_b, column_b)) return false;
  if (pixel != Pixel::kMeasured) return true;
  const RoundedPixel first = a.rounded(row_a, column_a), second = b.rounded(row_b, column_b);
  return first.range == second.range && first.offset_left == second.offset_left &&
         first.offset_up == second.offset_up;
}

// m, of an about upright box from the sensor's vertical axis.
float HorizontalDistance(const Eigen::Isometry3f& T_sensor_object, const Eigen::Vector3f& low,
                         const Eigen::Vector3f& high) {
  const Eigen::Vector3f sensor =
      T_sensor_object.linear().transpose() * -T_sensor_object.translation();
  const Eigen::Vector3f nearest = sensor.cwiseMax(low).cwiseMin(high);
  return (nearest - sensor).head<2>().norm();
}

}  // namespace

ImageChange::ImageChange(const RangeImage& before, const RangeImage& now)
    : grid_(now.grid()),
      R_axis_sensor_(AxisFromSensor(grid_).cast<float>()),
      width_before_(before.width()) {
  const PixelGrid& old = before.grid();
  const bool comparable = old.size() > 0 && grid_.size() > 0 && IsSamePlane(old, grid_) &&
                          before.T_local_sensor().matrix() == now.T_local_sensor().matrix() &&
                          WholePixels((grid_.top - old.top) / grid_.resolution, &row_shift_) &&
                          WholePixels((grid_.left - old.left) / grid_.resolution, &column_shift_);
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
  const Eigen::Vector3d p_sensor = centre.cast<double>();
  const double distance = p_sensor.norm();
  // Around the sensor, beside what the image can hold, or not a number.
  if (!(distance > radius) || !CanHold(grid_, p_sensor)) return true;
  constexpr double kRounding = 1e-4;  // of the radius, more than that of points and floats
  const double sine = std::min((1.0 + kRounding) * radius / distance, 1.0);
  const PixelPosition at = Project(grid_, p_sensor);
  PixelReach reach;
  bool all_around = false;
  if (grid_.projection == Projection::kPinhole) {
    reach = PinholeReach(grid_, CoordinatesAt(grid_, at.row, at.column), sine);
  } else {
    const Direction middle = DirectionOf(p_sensor);
    const double angle = std::asin(sine);
    // Meridians converge towards the poles; a ball over one is all around, and so is one behind.
    double half_width = kPi;
    if (std::abs(middle.elevation) + angle < 0.5 * kPi)
      half_width = std::asin(std::min(sine / std::cos(middle.elevation), 1.0));
    all_around = std::abs(middle.azimuth) + half_width >= kPi;
    reach = {angle / grid_.resolution, half_width / grid_.resolution};
  }
  return CountChanged(static_cast<int>(std::floor(at.row - reach.rows)),
                      static_cast<int>(std::floor(at.row + reach.rows)),
                      all_around ? 0 : static_cast<int>(std::floor(at.column - reach.columns)),
                      all_around ? grid_.width - 1
                                 : static_cast<int>(std::floor(at.column + reach.columns))) > 0;
}

bool ImageChange::TouchesBox(const Eigen::Isometry3f& T_sensor_object, const Eigen::Vector3f& low,
                             const Eigen::Vector3f& high) const {
  if (everything_ || !T_sensor_object.matrix().allFinite()) return true;
  const bool pinhole = grid_.projection == Projection::kPinhole;
  const Eigen::Isometry3f T_axis_object = R_axis_sensor_ * T_sensor_object;
  float right = kFar, left = -kFar, bottom = kFar, top = -kFar;  // image coordinates
  float lowest = kFar, highest = -kFar;                          // m
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f p = T_axis_object * Eigen::Vector3f((corner & 1 ? high : low).x(),
                                                              (corner & 2 ? high : low).y(),
                                                              (corner & 4 ? high : low).z());
    if (pinhole && !(p.x() > static_cast<float>(kMinPinholeCosine) * p.norm())) return true;
    const float to_left = pinhole ? p.y() / p.x() : FastAtan2(p.y(), p.x());
    const float upwards = pinhole ? p.z() / p.x() : FastAtan2(p.z(), p.head<2>().norm());
    lowest = std::min(lowest, p.z());
    highest = std::max(highest, p.z());
    right = std::min(right, to_left);
    left = std::max(left, to_left);
    bottom = std::min(bottom, upwards);
    top = std::max(top, upwards);
  }
  if (!pinhole) {
    // Half around and more: behind the sensor, where azimuths begin again, or about it.
    if (left - right >= static_cast<float>(kPi)) return true;
    // Sides are steepest where they are nearest, between the corners.
    const float nearest = HorizontalDistance(T_sensor_object, low, high);
    bottom = std::min(bottom, FastAtan2(lowest, nearest));
    top = std::max(top, FastAtan2(highest, nearest));
  }
  const PixelPosition first = PositionOf(grid_, {left, top});
  const PixelPosition last = PositionOf(grid_, {right, bottom});
  return CountChanged(static_cast<int>(std::floor(first.row)),
                      static_cast<int>(std::floor(last.row)),
                      static_cast<int>(std::floor(first.column)),
                      static_cast<int>(std::floor(last.column))) > 0;
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
