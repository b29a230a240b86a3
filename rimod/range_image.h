#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "rimod/execution.h"
#include "rimod/pixel_grid.h"
#include "rimod/scan.h"

namespace rimod {

// What a pixel of a range image knows.
enum class Pixel : std::uint8_t { kNeverObserved, kNoReturn, kMeasured };

// Steps in which range images keep their values, so that a message holds the very same ones.
struct PixelRounding {
  static constexpr double kRangeUnit = 0.00125;  // m, error at most 0.6 mm; 16 bits reach 81.9 m
  static constexpr int kMaxRangeSteps = 65534;   // "that far or farther"
  static constexpr int kOffsetSteps = 256;  // a pixel's width in steps of the sub-pixel direction
};

// One measured pixel in its rounded form.
struct RoundedPixel {
  std::uint16_t range = 0;      // in kRangeUnit, 1 .. kMaxRangeSteps
  std::int8_t offset_left = 0;  // in 1 / kOffsetSteps of the resolution, from the pixel's centre
  std::int8_t offset_up = 0;
};

// A range image (paper, section III-A): per pixel the nearest point measured in its direction.
// Points are kept as they were measured, not moved to pixel centres. Values are rounded
// (PixelRounding) when a pixel is set, so that the image can be sent and read back bit for bit.
class RangeImage {
 public:
  RangeImage() = default;
  // All pixels never observed. Throws std::invalid_argument for a grid with a negative or absurd
  // size (over 16 million pixels), resolution, edge or axis.
  RangeImage(const PixelGrid& grid, const Eigen::Isometry3d& T_local_sensor);

  const PixelGrid& grid() const { return grid_; }
  int width() const { return grid_.width; }
  int height() const { return grid_.height; }
  // Level sensor frame to local frame.
  const Eigen::Isometry3d& T_local_sensor() const { return T_local_sensor_; }

  Pixel pixel(int row, int column) const;
  bool measured(int row, int column) const { return range(row, column) > 0.0f; }
  // m; 0 where nothing was measured.
  float range(int row, int column) const { return ranges_[Index(row, column)]; }
  // Level sensor frame, m; zero where nothing was measured.
  const Eigen::Vector3f& point(int row, int column) const { return points_[Index(row, column)]; }
  RoundedPixel rounded(int row, int column) const { return rounded_[Index(row, column)]; }

  void SetMeasured(int row, int column, const RoundedPixel& rounded);
  void SetNoReturn(int row, int column);
  // Keeps the nearer of the pixel's point and each beam's (z-buffer); one range (m) a beam. Beams
  // outside the grid are left out.
  void AddBeams(const std::vector<ImageCoordinates>& beams, const std::vector<double>& ranges,
                const Execution& execution = {});
  // Marks a pixel in which nothing is measured.
  void AddNoReturn(const ImageCoordinates& beam);

  int CountMeasured() const;

 private:
  int Index(int row, int column) const { return row * grid_.width + column; }

  PixelGrid grid_;
  Eigen::Matrix3d R_sensor_axis_ = Eigen::Matrix3d::Identity();  // of a pinhole grid
  Eigen::Isometry3d T_local_sensor_ = Eigen::Isometry3d::Identity();
  std::vector<float> ranges_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<RoundedPixel> rounded_;  // range 0: never observed or no return
  std::vector<std::uint8_t> no_return_;
};

// Neighbouring pixels by index, row after row.
struct PixelRun {
  int first = 0;
  int count = 0;
};

struct RangeImageParams {
  // Pinhole: about the middle of the field of view, in whole degrees; spherical where a beam is
  // more than 60 degrees away from it.
  Projection projection = Projection::kSpherical;
  // rad per pixel (0.4 deg, paper section V), pinhole on the axis; 0.001 .. 0.1
  double resolution = 0.00698131700797732;
  // rad; scans too sparse for that get larger pixels, up to this: the smallest of which min_filled
  // is observed. 0 .. 0.1, up to resolution: never
  double max_resolution = 0.0;
  double min_filled = 0.7;  // of the pixels beside measured ones; 0 .. 1
  double min_range = 0.1;   // m, nearer points belong to the sensor's carrier; >= 0
  void Validate() const;
};

// Whether an image is spherical because the scan's field of view is too wide for the pinhole image
// that was asked for.
bool IsTooWideForPinhole(const RangeImage& image, const RangeImageParams& params);

// The z-buffered range image of a scan from its sensor position; the grid is the smallest that
// holds all points and no-return beams, its edges at whole multiples of the resolution. An empty
// scan gives an image of size 0. The image's grid tells its projection.
RangeImage MakeRangeImage(const Scan& scan, const RangeImageParams& params,
                          const Execution& execution = {});

}  // namespace rimod
