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
  Eigen::Vector3f normal;  // sensor frame
  float plane = 0.0f;  // m, the disc's plane: a beam along unit vector u meets it at plane / n.u
  float range = 0.0f;  // m
  Extent rows, columns;
  int index = 0;
};

// Points that face the sensor, by coordinate (m, sensor frame), and where they are seen.
struct FacingPoints {
  std::vector<int> indices;
  std::vector<float> planes;
  std::vector<float> x, y, z;
  std::vector<float> ranges, rows, columns, reach_columns;
};

FacingPoints FindFacing(const ObjectModel& model, const Eigen::Isometry3f& T_sensor_object,
                        float radius) {
  const Eigen::Vector3f sensor = T_sensor_object.inverse().translation();
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
    const Eigen::Vector3f point = T_sensor_object * model.points[i];
    facing.indices.push_back(static_cast<int>(i));
    facing.planes.push_back(-height);
    facing.x.push_back(point.x());
    facing.y.push_back(point.y());
    facing.z.push_back(point.z());
  }
  return facing;
}

RIMOD_WIDE_LOOPS void ProjectAll(const SphericalGrid& grid, float radius, FacingPoints* facing) {
  const std::size_t count = facing->x.size();
  for (std::vector<float>* const column :
       {&facing->ranges, &facing->rows, &facing->columns, &facing->reach_columns})
    column->resize(count);
  const float left = static_cast<float>(grid.azimuth_left);
  const float top = static_cast<float>(grid.elevation_top);
  const float per_radian = static_cast<float>(1.0 / grid.resolution);
  const float* const px = facing->x.data();
  const float* const py = facing->y.data();
  const float* const pz = facing->z.data();
  float* const ranges = facing->ranges.data();
  float* const rows = facing->rows.data();
  float* const columns = facing->columns.data();
  float* const reach_columns = facing->reach_columns.data();
  for (std::size_t i = 0; i < count; ++i) {
    const float horizontal_sq = px[i] * px[i] + py[i] * py[i];
    const float horizontal = std::sqrt(horizontal_sq);
    ranges[i] = std::sqrt(horizontal_sq + pz[i] * pz[i]);
    columns[i] = (left - FastAtan2(py[i], px[i])) * per_radian;
    rows[i] = (top - FastAtan2(pz[i], horizontal)) * per_radian;
    reach_columns[i] = radius / (horizontal > radius ? horizontal : radius) * per_radian;
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
std::vector<Splat> VisibleSplats(const ObjectModel& model, const Eigen::Isometry3f& T_sensor_object,
                                 const SphericalGrid& grid) {
  const float radius = kDiscRadius * static_cast<float>(model.point_spacing);
  FacingPoints facing = FindFacing(model, T_sensor_object, radius);
  ProjectAll(grid, radius, &facing);
  const float per_radian = static_cast<float>(1.0 / grid.resolution);
  std::vector<Splat> splats;
  splats.reserve(facing.indices.size());
  for (std::size_t i = 0; i < facing.indices.size(); ++i) {
    Splat splat;
    splat.rows = CoveredPixels(facing.rows[i], radius / facing.ranges[i] * per_radian, grid.height);
    splat.columns = CoveredPixels(facing.columns[i], facing.reach_columns[i], grid.width);
    if (splat.rows.first > splat.rows.last || splat.columns.first > splat.columns.last) continue;
    splat.normal = T_sensor_object.linear() * model.normals[facing.indices[i]];
    splat.plane = facing.planes[i];
    splat.range = facing.ranges[i];
    splat.index = facing.indices[i];
    splats.push_back(splat);
  }
  return splats;
}

RenderedModel EmptyWindow(const std::vector<Splat>& splats, const SphericalGrid& grid) {
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

// Unit vectors through the pixels' centres of a window: of a row the cosine and sine of its
// elevation, of a column those of its azimuth.
struct BeamTable {
  BeamTable(const RenderedModel& window, const SphericalGrid& grid) {
    for (int row = 0; row < window.height; ++row) {
      const double elevation = PixelDirection(grid, window.first_row + row + 0.5, 0.0).elevation;
      rows.emplace_back(std::cos(elevation), std::sin(elevation));
    }
    for (int column = 0; column < window.width; ++column) {
      const double azimuth = PixelDirection(grid, 0.0, window.first_column + column + 0.5).azimuth;
      columns.emplace_back(std::cos(azimuth), std::sin(azimuth));
    }
  }
  std::vector<Eigen::Vector2f> rows, columns;
};

// Draws a disc; edge: m, how far from the middle's range its own may be.
void Draw(const Splat& splat, float edge, const BeamTable& beams, RenderedModel* rendered) {
  for (int row = splat.rows.first; row <= splat.rows.last; ++row) {
    const Eigen::Vector2f& elevation = beams.rows[row - rendered->first_row];
    const float nx = splat.normal.x() * elevation.x(), ny = splat.normal.y() * elevation.x();
    const float nz = splat.normal.z() * elevation.y();
    int pixel = (row - rendered->first_row) * rendered->width + splat.columns.first -
                rendered->first_column;
    for (int column = splat.columns.first; column <= splat.columns.last; ++column, ++pixel) {
      const Eigen::Vector2f& azimuth = beams.columns[column - rendered->first_column];
      const float cosine = std::min(nx * azimuth.x() + ny * azimuth.y() + nz, -kMinCosine);
      const float range = std::clamp(splat.plane / cosine, splat.range - edge, splat.range + edge);
      if (rendered->points[pixel] >= 0 && rendered->ranges[pixel] <= range) continue;
      rendered->ranges[pixel] = range;
      rendered->points[pixel] = splat.index;
    }
  }
}

}  // namespace

int RenderedModel::CountSeen() const {
  return static_cast<int>(
      std::count_if(points.begin(), points.end(), [](int point) { return point >= 0; }));
}

RenderedModel RenderModel(const ObjectModel& model, const Eigen::Isometry3d& T_sensor_object,
                          const SphericalGrid& grid) {
  if (grid.size() == 0) return {};
  const std::vector<Splat> splats = VisibleSplats(model, T_sensor_object.cast<float>(), grid);
  RenderedModel rendered = EmptyWindow(splats, grid);
  const BeamTable beams(rendered, grid);
  const float edge = 2.0f * static_cast<float>(model.point_spacing);
  for (const Splat& splat : splats) Draw(splat, edge, beams, &rendered);
  return rendered;
}

}  // namespace rimod
