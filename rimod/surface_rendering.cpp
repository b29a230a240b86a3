#include "rimod/surface_rendering.h"

#include <algorithm>
#include <cmath>

#include "rimod/facing_points.h"

namespace rimod {
namespace {

constexpr float kDiscRadius =
    0.75f;  // of the point spacing: discs of a square lattice (0.71) overlap

struct Extent {
  int first = 0, last = -1;
};

// A disc and the pixels that it covers.
struct Splat {
  Eigen::Vector3f normal;  // frame of the grid's axis
  float plane = 0.0f;  // m, the disc's plane: a beam along unit vector u meets it at plane / n.u
  float range = 0.0f;  // m
  Extent rows, columns;
  int index = 0;
};

int Floor(float value) {
  const int whole = static_cast<int>(value);
  return whole - (static_cast<float>(whole) > value ? 1 : 0);
}

// Pixels whose centres lie within reach of the position, at least the one that holds it.
Extent CoveredPixels(float position, float reach, int size) {
  const int own = Floor(position);
  const int first = std::min(own, -Floor(reach + 0.5f - position));
  const int last = std::max(own, Floor(position + reach - 0.5f));
  return {std::max(first, 0), std::min(last, size - 1)};
}

// Those that cover a pixel of the grid.
std::vector<Splat> VisibleSplats(const ObjectModel& model, const Eigen::Isometry3f& T_axis_object,
                                 const PixelGrid& grid) {
  const float radius = kDiscRadius * static_cast<float>(model.point_spacing);
  const FacingPoints facing = FindFacing(model, T_axis_object, radius, grid);
  std::vector<Splat> splats;
  splats.reserve(facing.indices.size());
  for (std::size_t i = 0; i < facing.indices.size(); ++i) {
    Splat splat;
    splat.rows = CoveredPixels(facing.rows[i], facing.reach_rows[i], grid.height);
    splat.columns = CoveredPixels(facing.columns[i], facing.reach_columns[i], grid.width);
    if (splat.rows.first > splat.rows.last || splat.columns.first > splat.columns.last) continue;
    splat.normal = T_axis_object.linear() * model.normals[facing.indices[i]];
    splat.plane = facing.planes[i];
    splat.range = facing.ranges[i];
    splat.index = facing.indices[i];
    splats.push_back(splat);
  }
  return splats;
}

RenderedModel EmptyWindow(const std::vector<Splat>& splats, const PixelGrid& grid) {
  int row_min = grid.height, row_max = -1, column_min = grid.width, column_max = -1;
  for (const Splat& splat : splats) {
    row_min = std::min(row_min, splat.rows.first);
    row_max = std::max(row_max, splat.rows.last);
    column_min = std::min(column_min, splat.columns.first);
    column_max = std::max(column_max, splat.columns.last);
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

// Unit vectors through the pixels' centres of a window of a spherical grid: of a row the cosine and
// sine of its elevation, of a column those of its azimuth.
class SphericalBeams {
 public:
  SphericalBeams(const RenderedModel& window, const PixelGrid& grid) {
    for (int row = 0; row < window.height; ++row) {
      const double elevation = CoordinatesAt(grid, window.first_row + row + 0.5, 0.0).up;
      rows_.emplace_back(std::cos(elevation), std::sin(elevation));
    }
    for (int column = 0; column < window.width; ++column) {
      const double azimuth = CoordinatesAt(grid, 0.0, window.first_column + column + 0.5).left;
      columns_.emplace_back(std::cos(azimuth), std::sin(azimuth));
    }
  }

  // Cosines between a direction and the beams of a row, by column.
  struct Row {
    float operator()(int column) const {
      const Eigen::Vector2f& azimuth = (*columns)[column];
      return nx * azimuth.x() + ny * azimuth.y() + nz;
    }
    const std::vector<Eigen::Vector2f>* columns;
    float nx, ny, nz;
  };
  Row Cosines(const Eigen::Vector3f& normal, int row) const {
    const Eigen::Vector2f& elevation = rows_[row];
    return {&columns_, normal.x() * elevation.x(), normal.y() * elevation.x(),
            normal.z() * elevation.y()};
  }

 private:
  std::vector<Eigen::Vector2f> rows_, columns_;
};

// The same of a pinhole grid, in the frame of its axis.
class PinholeBeams {
 public:
  PinholeBeams(const RenderedModel& window, const PixelGrid& grid) : width_(window.width) {
    for (int column = 0; column < window.width; ++column) {
      lefts_.push_back(
          static_cast<float>(CoordinatesAt(grid, 0.0, window.first_column + column + 0.5).left));
    }
    inverse_lengths_.reserve(static_cast<std::size_t>(window.height) * window.width);
    for (int row = 0; row < window.height; ++row) {
      const float up =
          static_cast<float>(CoordinatesAt(grid, window.first_row + row + 0.5, 0.0).up);
      ups_.push_back(up);
      for (const float left : lefts_)
        inverse_lengths_.push_back(1.0f / std::sqrt(1.0f + left * left + up * up));
    }
  }

  struct Row {
    float operator()(int column) const {
      return (ny * lefts[column] + n) * inverse_lengths[column];
    }
    const float* lefts;
    const float* inverse_lengths;
    float ny, n;
  };
  Row Cosines(const Eigen::Vector3f& normal, int row) const {
    return {lefts_.data(), inverse_lengths_.data() + static_cast<std::size_t>(row) * width_,
            normal.y(), normal.x() + normal.z() * ups_[row]};
  }

 private:
  int width_;
  std::vector<float> lefts_, ups_, inverse_lengths_;
};

// Draws a disc; edge: m, how far from the middle's range its own may be.
template <typename Beams>
void Draw(const Splat& splat, float edge, const Beams& beams, RenderedModel* rendered) {
  for (int row = splat.rows.first; row <= splat.rows.last; ++row) {
    const typename Beams::Row cosines = beams.Cosines(splat.normal, row - rendered->first_row);
    int pixel = (row - rendered->first_row) * rendered->width + splat.columns.first -
                rendered->first_column;
    for (int column = splat.columns.first; column <= splat.columns.last; ++column, ++pixel) {
      const float cosine = std::min(cosines(column - rendered->first_column), -kMinFacingCosine);
      const float range = std::clamp(splat.plane / cosine, splat.range - edge, splat.range + edge);
      if (rendered->points[pixel] >= 0 && rendered->ranges[pixel] <= range) continue;
      rendered->ranges[pixel] = range;
      rendered->points[pixel] = splat.index;
    }
  }
}

template <typename Beams>
void DrawAll(const std::vector<Splat>& splats, float edge, const PixelGrid& grid,
             RenderedModel* rendered) {
  const Beams beams(*rendered, grid);
  for (const Splat& splat : splats) Draw(splat, edge, beams, rendered);
}

}  // namespace

int RenderedModel::CountSeen() const {
  return static_cast<int>(
      std::count_if(points.begin(), points.end(), [](int point) { return point >= 0; }));
}

RenderedModel RenderModel(const ObjectModel& model, const Eigen::Isometry3d& T_sensor_object,
                          const PixelGrid& grid) {
  if (grid.size() == 0) return {};
  const bool is_pinhole = grid.projection == Projection::kPinhole;
  Eigen::Isometry3d T_axis_object = T_sensor_object;
  if (is_pinhole) T_axis_object.prerotate(AxisFromSensor(grid));
  const std::vector<Splat> splats = VisibleSplats(model, T_axis_object.cast<float>(), grid);
  RenderedModel rendered = EmptyWindow(splats, grid);
  const float edge = 2.0f * static_cast<float>(model.point_spacing);
  if (is_pinhole) {
    DrawAll<PinholeBeams>(splats, edge, grid, &rendered);
  } else {
    DrawAll<SphericalBeams>(splats, edge, grid, &rendered);
  }
  return rendered;
}

}  // namespace rimod
