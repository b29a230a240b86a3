#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "rimod/range_image.h"

namespace rimod {

// Where a range image differs from an earlier one of the same place, for work on what is new only.
class ImageChange {
 public:
  // Everything is new.
  ImageChange() = default;
  // The images are compared where the earlier one's grid lies in the new one: both must have one
  // sensor pose, projection and resolution, their edges whole pixels apart. Else everything is new.
  ImageChange(const RangeImage& before, const RangeImage& now);

  bool everything() const { return everything_; }
  // False when no pixel has changed that a ball (level sensor frame, m) may cover.
  bool Touches(const Eigen::Vector3f& centre, float radius) const;
  // The same of a box, low to high in the object frame, that stands about upright.
  bool TouchesBox(const Eigen::Isometry3f& T_sensor_object, const Eigen::Vector3f& low,
                  const Eigen::Vector3f& high) const;
  // The same for the pixels [row - reach, row + reach] x [column - reach, column + reach] of the
  // new image.
  bool TouchesPixels(int row, int column, int reach) const;

  // Where the earlier image's first pixel lies in the new one; only unless everything() is new.
  int row_shift() const { return row_shift_; }
  int column_shift() const { return column_shift_; }
  // The earlier image's pixels by the new one's indices, without those outside of it.
  std::vector<PixelRun> MovedRuns(const std::vector<PixelRun>& runs) const;

 private:
  int CountChanged(int first_row, int last_row, int first_column, int last_column) const;

  bool everything_ = true;
  PixelGrid grid_;  // of the new image
  Eigen::Matrix3f R_axis_sensor_ = Eigen::Matrix3f::Identity();
  int width_before_ = 0;
  int row_shift_ = 0, column_shift_ = 0;
  // How many pixels above and left of each have changed: (height + 1) x (width + 1).
  std::vector<int> changed_before_;
};

}  // namespace rimod
