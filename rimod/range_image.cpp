#include "rimod/range_image.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "rimod/check.h"
#include "rimod/pinhole_axis.h"

namespace rimod {
namespace {

constexpr int kMaxPixels = 16'000'000;

void CheckGrid(const PixelGrid& grid) {
  const bool sane_size = grid.width >= 0 && grid.height >= 0 &&
                         static_cast<std::int64_t>(grid.width) * grid.height <= kMaxPixels;
  if (!sane_size) {
    throw std::invalid_argument("range image of " + std::to_string(grid.width) + " x " +
                                std::to_string(grid.height) + " pixels");
  }
  if (grid.size() > 0 && !(std::isfinite(grid.resolution) && grid.resolution > 0.0)) {
    throw std::invalid_argument("range image with resolution " + std::to_string(grid.resolution));
  }
  if (!std::isfinite(grid.left) || !std::isfinite(grid.top)) {
    throw std::invalid_argument("range image whose edges are not finite");
  }
  if (!std::isfinite(grid.axis.azimuth) || !std::isfinite(grid.axis.elevation)) {
    throw std::invalid_argument("range image whose axis is not finite");
  }
}

// The sub-pixel part of a position in steps, from the pixel's centre, growing against the index
// (image coordinates fall with column and row).
std::int8_t OffsetSteps(double position, int index) {
  const double steps = (index + 0.5 - position) * PixelRounding::kOffsetSteps;
  return static_cast<std::int8_t>(std::clamp(std::lround(steps), -128L, 127L));
}

std::uint16_t RangeSteps(double range) {
  const double steps = std::clamp(std::round(range / PixelRounding::kRangeUnit), 1.0,
                                  static_cast<double>(PixelRounding::kMaxRangeSteps));
  return static_cast<std::uint16_t>(steps);
}

struct Bounds {
  double left_min = kNone, left_max = -kNone;
  double up_min = kNone, up_max = -kNone;
  void Include(const ImageCoordinates& coordinates) {
    left_min = std::min(left_min, coordinates.left);
    left_max = std::max(left_max, coordinates.left);
    up_min = std::min(up_min, coordinates.up);
    up_max = std::max(up_max, coordinates.up);
  }
  bool empty() const { return left_min > left_max; }

  static constexpr double kNone = 1e6;  // beyond every coordinate
};

// Calls body(i) for i in [0, count), many in one piece of work.
template <typename Body>
void ForEach(std::size_t count, const Execution& execution, const Body& body) {
  constexpr std::size_t kPieces = 64;
  execution.parallel_for(kPieces, [&](std::size_t piece) {
    const std::size_t end = (piece + 1) * count / kPieces;
    for (std::size_t i = piece * count / kPieces; i < end; ++i) body(i);
  });
}

// A grid without pixels yet: the projection and its axis.
PixelGrid PlaneFor(const Scan& scan, const RangeImageParams& params) {
  PixelGrid plane;
  if (params.projection != Projection::kPinhole) return plane;
  const std::optional<Direction> axis = PinholeAxis(scan, params.min_range);
  if (!axis) return plane;
  plane.projection = Projection::kPinhole;
  plane.axis = *axis;
  return plane;
}

// A grid like the given one, with these pixels, that holds what is within the bounds.
PixelGrid GridFor(PixelGrid grid, const Bounds& bounds, double resolution) {
  grid.resolution = resolution;
  if (bounds.empty()) return grid;
  grid.left = (std::floor(bounds.left_max / resolution) + 1.0) * resolution;
  grid.top = (std::floor(bounds.up_max / resolution) + 1.0) * resolution;
  // By projecting the last beam, so that one exactly on a pixel's edge falls into the grid too.
  const PixelPosition last = PositionOf(grid, {bounds.left_min, bounds.up_min});
  grid.width = static_cast<int>(std::floor(last.column)) + 1;
  grid.height = static_cast<int>(std::floor(last.row)) + 1;
  return grid;
}

// The share of the pixels right of and below measured ones that were observed.
double FilledShare(const RangeImage& image) {
  std::int64_t beside = 0, observed = 0;
  for (int row = 0; row + 1 < image.height(); ++row) {
    for (int column = 0; column + 1 < image.width(); ++column) {
      if (!image.measured(row, column)) continue;
      beside += 2;
      observed += image.pixel(row, column + 1) != Pixel::kNeverObserved;
      observed += image.pixel(row + 1, column) != Pixel::kNeverObserved;
    }
  }
  return beside > 0 ? static_cast<double>(observed) / static_cast<double>(beside) : 1.0;
}

}  // namespace

RangeImage::RangeImage(const PixelGrid& grid, const Eigen::Isometry3d& T_local_sensor)
    : grid_(grid),
      R_sensor_axis_(AxisFromSensor(grid).transpose()),
      T_local_sensor_(T_local_sensor) {
  CheckGrid(grid);
  const std::size_t size = static_cast<std::size_t>(grid.size());
  ranges_.assign(size, 0.0f);
  points_.assign(size, Eigen::Vector3f::Zero());
  rounded_.assign(size, RoundedPixel{});
  no_return_.assign(size, 0);
}

Pixel RangeImage::pixel(int row, int column) const {
  const int index = Index(row, column);
  if (rounded_[index].range > 0) return Pixel::kMeasured;
  return no_return_[index] ? Pixel::kNoReturn : Pixel::kNeverObserved;
}

void RangeImage::SetMeasured(int row, int column, const RoundedPixel& rounded) {
  const int index = Index(row, column);
  constexpr double kOffsetUnit = 1.0 / PixelRounding::kOffsetSteps;
  const ImageCoordinates at = CoordinatesAt(grid_, row + 0.5 - rounded.offset_up * kOffsetUnit,
                                            column + 0.5 - rounded.offset_left * kOffsetUnit);
  const Eigen::Vector3d beam =
      grid_.projection == Projection::kSpherical
          ? UnitVector({at.left, at.up})
          : R_sensor_axis_ * Eigen::Vector3d(1.0, at.left, at.up).normalized();
  const double range = rounded.range * PixelRounding::kRangeUnit;
  rounded_[index] = rounded;
  ranges_[index] = static_cast<float>(range);
  points_[index] = (range * beam).cast<float>();
  no_return_[index] = 0;
}

void RangeImage::SetNoReturn(int row, int column) {
  const int index = Index(row, column);
  rounded_[index] = RoundedPixel{};
  ranges_[index] = 0.0f;
  points_[index].setZero();
  no_return_[index] = 1;
}

void RangeImage::AddBeams(const std::vector<ImageCoordinates>& beams,
                          const std::vector<double>& ranges, const Execution& execution) {
  struct Beam {
    int index = -1;  // of its pixel
    RoundedPixel pixel;
  };
  std::vector<Beam> placed(beams.size());
  ForEach(beams.size(), execution, [&](std::size_t i) {
    const PixelPosition position = PositionOf(grid_, beams[i]);
    const int row = static_cast<int>(std::floor(position.row));
    const int column = static_cast<int>(std::floor(position.column));
    if (!grid_.Contains(row, column)) return;
    placed[i].index = Index(row, column);
    placed[i].pixel = {RangeSteps(ranges[i]), OffsetSteps(position.column, column),
                       OffsetSteps(position.row, row)};
  });
  // z-buffer: the nearest beam of each pixel; only those are worth computing a point for.
  std::vector<RoundedPixel> nearest(rounded_);
  for (const Beam& beam : placed) {
    if (beam.index < 0) continue;
    RoundedPixel& pixel = nearest[beam.index];
    if (pixel.range == 0 || beam.pixel.range < pixel.range) pixel = beam.pixel;
  }
  execution.parallel_for(static_cast<std::size_t>(height()), [&](std::size_t i) {
    const int row = static_cast<int>(i);
    for (int column = 0; column < width(); ++column) {
      const RoundedPixel& pixel = nearest[Index(row, column)];
      if (pixel.range != 0) SetMeasured(row, column, pixel);
    }
  });
}

void RangeImage::AddNoReturn(const ImageCoordinates& beam) {
  const PixelPosition position = PositionOf(grid_, beam);
  const int row = static_cast<int>(std::floor(position.row));
  const int column = static_cast<int>(std::floor(position.column));
  if (grid_.Contains(row, column) && !measured(row, column)) SetNoReturn(row, column);
}

int RangeImage::CountMeasured() const {
  return static_cast<int>(
      std::count_if(ranges_.begin(), ranges_.end(), [](float range) { return range > 0.0f; }));
}

void RangeImageParams::Validate() const {
  if (!(resolution >= 0.001 && resolution <= 0.1)) {
    throw std::invalid_argument("range_image resolution is " + std::to_string(resolution) +
                                " rad, not within 0.001 .. 0.1");
  }
  CheckWithin("range_image max_resolution", max_resolution, 0.0, 0.1);
  CheckWithin("range_image min_filled", min_filled, 0.0, 1.0);
  if (!(min_range >= 0.0 && std::isfinite(min_range))) {
    throw std::invalid_argument("range_image min_range is " + std::to_string(min_range));
  }
}

bool IsTooWideForPinhole(const RangeImage& image, const RangeImageParams& params) {
  return params.projection == Projection::kPinhole && image.grid().size() > 0 &&
         image.grid().projection == Projection::kSpherical;
}

RangeImage MakeRangeImage(const Scan& scan, const RangeImageParams& params,
                          const Execution& execution) {
  params.Validate();
  const Eigen::Isometry3d T_sensor_local = scan.T_local_sensor.inverse();
  const PixelGrid plane = PlaneFor(scan, params);
  Eigen::Isometry3d T_axis_local = T_sensor_local;
  if (plane.projection == Projection::kPinhole) T_axis_local.prerotate(AxisFromSensor(plane));

  // Slots by point, range 0 where it does not count; then those that do move together.
  std::vector<ImageCoordinates> beams(scan.points.size());
  std::vector<double> ranges(scan.points.size());
  ForEach(ranges.size(), execution, [&](std::size_t i) {
    const Eigen::Vector3d p_axis = T_axis_local * scan.points[i].cast<double>();
    const double range = p_axis.norm();
    if (!(range >= params.min_range && range > 0.0)) return;
    ranges[i] = range;
    beams[i] = CoordinatesOf(plane.projection, p_axis);
  });
  Bounds bounds;
  std::size_t count = 0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (ranges[i] == 0.0) continue;
    bounds.Include(beams[i]);
    ranges[count] = ranges[i];
    beams[count++] = beams[i];
  }
  ranges.resize(count);
  beams.resize(count);
  std::vector<ImageCoordinates> no_returns(scan.no_return_directions.size());
  ForEach(no_returns.size(), execution, [&](std::size_t i) {
    no_returns[i] = CoordinatesOf(
        plane.projection, T_axis_local.linear() * scan.no_return_directions[i].cast<double>());
  });
  for (const ImageCoordinates& beam : no_returns) bounds.Include(beam);

  constexpr double kStep = 1.25;  // from one resolution to the next
  for (double resolution = params.resolution;; resolution *= kStep) {
    RangeImage image(GridFor(plane, bounds, resolution), scan.T_local_sensor);
    image.AddBeams(beams, ranges, execution);
    for (const ImageCoordinates& beam : no_returns) image.AddNoReturn(beam);
    const bool coarsest = resolution * kStep > params.max_resolution;
    if (coarsest || FilledShare(image) >= params.min_filled) return image;
  }
}

}  // namespace rimod
