#include "rimod/surface_rendering.h"

#include <algorithm>
#include <cmath>

namespace rimod {
namespace {

constexpr double kDiscRadius =
    0.75;  // of the point spacing: discs of a square lattice (0.71) overlap
constexpr double kMinCosine = 0.08;  // surfaces seen at a flatter angle give no reliable range

struct Splat {
  Eigen::Vector3d point;   // m, sensor frame
  Eigen::Vector3d normal;  // sensor frame
  double range = 0.0;
  double row = 0.0, column = 0.0;
  double reach_rows = 0.0, reach_columns = 0.0;  // pixels
  int index = 0;
};

std::vector<Splat> VisibleSplats(const ObjectModel& model, const Eigen::Isometry3d& T_sensor_object,
                                 const SphericalGrid& grid) {
  std::vector<Splat> splats;
  splats.reserve(model.points.size());
  const double radius = kDiscRadius * model.point_spacing;
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    Splat splat;
    splat.point = T_sensor_object * model.points[i].cast<double>();
    splat.normal = T_sensor_object.linear() * model.normals[i].cast<double>();
    splat.range = splat.point.norm();
    if (splat.range <= radius) continue;
    if (splat.normal.dot(splat.point) > -kMinCosine * splat.range) continue;
    const PixelPosition position = Project(grid, splat.point);
    splat.row = position.row;
    splat.column = position.column;
    splat.reach_rows = radius / splat.range / grid.resolution;
    const double horizontal = splat.point.head<2>().norm();
    splat.reach_columns = radius / std::max(horizontal, radius) / grid.resolution;
    splat.index = static_cast<int>(i);
    splats.push_back(splat);
  }
  return splats;
}

struct Extent {
  int first = 0, last = -1;
};

// Pixels whose centres lie within reach of the position, at least the one that holds it.
Extent CoveredPixels(double position, double reach, int size) {
  const int own = static_cast<int>(std::floor(position));
  const int first = std::min(own, static_cast<int>(std::ceil(position - reach - 0.5)));
  const int last = std::max(own, static_cast<int>(std::floor(position + reach - 0.5)));
  return {std::max(first, 0), std::min(last, size - 1)};
}

RenderedModel EmptyWindow(const std::vector<Splat>& splats, const SphericalGrid& grid) {
  int row_min = grid.height, row_max = -1, column_min = grid.width, column_max = -1;
  for (const Splat& splat : splats) {
    const Extent rows = CoveredPixels(splat.row, splat.reach_rows, grid.height);
    const Extent columns = CoveredPixels(splat.column, splat.reach_columns, grid.width);
    if (rows.first > rows.last || columns.first > columns.last) continue;
    row_min = std::min(row_min, rows.first);
    row_max = std::max(row_max, rows.last);
    column_min = std::min(column_min, columns.first);
    column_max = std::max(column_max, columns.last);
  }
  RenderedModel rendered;
  if (row_max < row_min) return rendered;
  rendered.first_row = row_min;
  rendered.first_column = column_min;
  rendered.height = row_max - row_min + 1;
  rendered.width = column_max - column_min + 1;
  rendered.ranges.assign(static_cast<std::size_t>(rendered.height) * rendered.width, 0.0f);
  rendered.points.assign(rendered.ranges.size(), -1);
  return rendered;
}

// Unit vectors through the pixels' centres of a window.
class BeamTable {
 public:
  BeamTable(const RenderedModel& window, const SphericalGrid& grid) {
    for (int row = 0; row < window.height; ++row) {
      const Direction direction = PixelDirection(grid, window.first_row + row + 0.5, 0.0);
      vertical_.emplace_back(std::cos(direction.elevation), std::sin(direction.elevation));
    }
    for (int column = 0; column < window.width; ++column) {
      const Direction direction = PixelDirection(grid, 0.0, window.first_column + column + 0.5);
      horizontal_.emplace_back(std::cos(direction.azimuth), std::sin(direction.azimuth));
    }
  }
  Eigen::Vector3d At(int row, int column) const {
    const Eigen::Vector2d& v = vertical_[row];
    const Eigen::Vector2d& h = horizontal_[column];
    return {v.x() * h.x(), v.x() * h.y(), v.y()};
  }

 private:
  std::vector<Eigen::Vector2d> vertical_, horizontal_;  // cosine and sine
};

}  // namespace

int RenderedModel::CountSeen() const {
  return static_cast<int>(
      std::count_if(points.begin(), points.end(), [](int point) { return point >= 0; }));
}

RenderedModel RenderModel(const ObjectModel& model, const Eigen::Isometry3d& T_sensor_object,
                          const SphericalGrid& grid) {
  const std::vector<Splat> splats = VisibleSplats(model, T_sensor_object, grid);
  RenderedModel rendered = EmptyWindow(splats, grid);
  const BeamTable beams(rendered, grid);
  for (const Splat& splat : splats) {
    const Extent rows = CoveredPixels(splat.row, splat.reach_rows, grid.height);
    const Extent columns = CoveredPixels(splat.column, splat.reach_columns, grid.width);
    // The disc's plane: a beam along unit vector u meets it at range plane / (normal . u).
    const double plane = splat.normal.dot(splat.point);
    for (int row = rows.first; row <= rows.last; ++row) {
      for (int column = columns.first; column <= columns.last; ++column) {
        const Eigen::Vector3d beam =
            beams.At(row - rendered.first_row, column - rendered.first_column);
        const double on_plane = plane / std::min(splat.normal.dot(beam), -kMinCosine);
        const float range =
            static_cast<float>(std::clamp(on_plane, splat.range - 2 * model.point_spacing,
                                          splat.range + 2 * model.point_spacing));
        const int pixel =
            (row - rendered.first_row) * rendered.width + column - rendered.first_column;
        if (rendered.points[pixel] >= 0 && rendered.ranges[pixel] <= range) continue;
        rendered.ranges[pixel] = range;
        rendered.points[pixel] = splat.index;
      }
    }
  }
  return rendered;
}

}  // namespace rimod
