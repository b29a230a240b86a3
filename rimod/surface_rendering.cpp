#include "rimod/surface_rendering.h"

#include <algorithm>
#include <cmath>

#include "rimod/fast_atan2.h"
#include "rimod/wide_loops.h"

namespace rimod {
namespace {

constexpr float kDiscRadius =
    0.75f;  // of the point spacing: discs of a square lattice (0.71) overlap
constexpr float kMinCosine = 0.08f;  // surfaces seen at a flatter angle give no reliable range

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

// Points that face the sensor, by coordinate (m, frame of the grid's axis), and where they are
// seen.
struct FacingPoints {
  std::vector<int> indices;
  std::vector<float> planes;
  std::vector<float> x, y, z;
  std::vector<float> ranges, rows, columns, reach_rows, reach_columns;  // pixels
};

FacingPoints FindFacing(const ObjectModel& model, const Eigen::Isometry3f& T_axis_object,
                        float radius) {
  const Eigen::Vector3f sensor = T_axis_object.inverse().translation();
  FacingPoints facing;
  for (std::vector<float>* const column : {&facing.planes, &facing.x, &facing.y, &facing.z})
    column->reserve(model.points.size() / 2);
  facing.indices.reserve(model.points.size() / 2);
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const Eigen::Vector3f to_sensor = sensor - model.points[i];
    const float range_sq = to_sensor.squaredNorm();
    const float height = model.normals[i].dot(to_sensor);  // of the sensor over the disc's plane
    const bool faces = height > 0.0f && height * height >= kMinCosine * kMinCosine * range_sq;
    if (!faces || range_sq <= radius * radius) continue;
    const Eigen::Vector3f point = T_axis_object * model.points[i];
    facing.indices.push_back(static_cast<int>(i));
    facing.planes.push_back(-height);
    facing.x.push_back(point.x());
    facing.y.push_back(point.y());
    facing.z.push_back(point.z());
  }
  return facing;
}

RIMOD_WIDE_LOOPS void ProjectSpherical(const PixelGrid& grid, float radius, FacingPoints* facing) {
  const std::size_t count = facing->x.size();
  const float left = static_cast<float>(grid.left);
  const float top = static_cast<float>(grid.top);
  const float per_radian = static_cast<float>(1.0 / grid.resolution);
  const float* const px = facing->x.data();
  const float* const py = facing->y.data();
  const float* const pz = facing->z.data();
  float* const ranges = facing->ranges.data();
  float* const rows = facing->rows.data();
  float* const columns = facing->columns.data();
  float* const reach_rows = facing->reach_rows.data();
  float* const reach_columns = facing->reach_columns.data();
  for (std::size_t i = 0; i < count; ++i) {
    const float horizontal_sq = px[i] * px[i] + py[i] * py[i];
    const float horizontal = std::sqrt(horizontal_sq);
    ranges[i] = std::sqrt(horizontal_sq + pz[i] * pz[i]);
    columns[i] = (left - FastAtan2(py[i], px[i])) * per_radian;
    rows[i] = (top - FastAtan2(pz[i], horizontal)) * per_radian;
    reach_rows[i] = radius / ranges[i] * per_radian;
    reach_columns[i] = radius / (horizontal > radius ? horizontal : radius) * per_radian;
  }
}

// Pixels from a coordinate of a disc's middle to the end of the ball around the disc: tan(a + b) -
// tan(a), where tan(a) is the coordinate's size and sin(b) = radius / in_plane, the distance in the
// plane of the coordinate and the axis.
inline float PinholeReach(float coordinate, float in_plane_sq, float radius_sq, float per_unit) {
  constexpr float kLeast = 0.25f;  // of what is nearer than a radius; keeps the reach finite
  const float rest_sq = in_plane_sq - radius_sq;
  const float tangent = std::sqrt(radius_sq / (rest_sq > radius_sq ? rest_sq : radius_sq));
  const float rest = 1.0f - std::abs(coordinate) * tangent;
  return tangent * (1.0f + coordinate * coordinate) / (rest > kLeast ? rest : kLeast) * per_unit;
}

RIMOD_WIDE_LOOPS void ProjectPinhole(const PixelGrid& grid, float radius, FacingPoints* facing) {
  constexpr float kMinHeld = static_cast<float>(kMinPinholeCosine);
  constexpr float kOutside = -1e6f;  // pixels
  const std::size_t count = facing->x.size();
  const float left = static_cast<float>(grid.left);
  const float top = static_cast<float>(grid.top);
  const float per_unit = static_cast<float>(1.0 / grid.resolution);
  const float radius_sq = radius * radius;
  const float* const px = facing->x.data();
  const float* const py = facing->y.data();
  const float* const pz = facing->z.data();
  float* const ranges = facing->ranges.data();
  float* const rows = facing->rows.data();
  float* const columns = facing->columns.data();
  float* const reach_rows = facing->reach_rows.data();
  float* const reach_columns = facing->reach_columns.data();
  for (std::size_t i = 0; i < count; ++i) {
    const float range_sq = px[i] * px[i] + py[i] * py[i] + pz[i] * pz[i];
    const float range = std::sqrt(range_sq);
    const bool held = px[i] > kMinHeld * range;
    const float per_depth = 1.0f / (held ? px[i] : range);
    const float to_left = py[i] * per_depth, upwards = pz[i] * per_depth;
    ranges[i] = range;
    columns[i] = held ? (left - to_left) * per_unit : kOutside;
    rows[i] = held ? (top - upwards) * per_unit : kOutside;
    const float across_rows = range_sq - py[i] * py[i];
    const float across_columns = range_sq - pz[i] * pz[i];
    reach_rows[i] = PinholeReach(upwards, across_rows, radius_sq, per_unit);
    reach_columns[i] = PinholeReach(to_left, across_columns, radius_sq, per_unit);
  }
}

void ProjectAll(const PixelGrid& grid, float radius, FacingPoints* facing) {
  for (std::vector<float>* const column : {&facing->ranges, &facing->rows, &facing->columns,
                                           &facing->reach_rows, &facing->reach_columns})
    column->resize(facing->x.size());
  if (grid.projection == Projection::kPinhole) {
    ProjectPinhole(grid, radius, facing);
  } else {
    ProjectSpherical(grid, radius, facing);
  }
}

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
  FacingPoints facing = FindFacing(model, T_axis_object, radius);
  ProjectAll(grid, radius, &facing);
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
      const float cosine = std::min(cosines(column - rendered->first_column), -kMinCosine);
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
