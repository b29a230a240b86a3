#include "rimod/facing_points.h"

#include <cmath>

#include "rimod/fast_atan2.h"
#include "rimod/wide_loops.h"

namespace rimod {
namespace {

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
// plane of the coordinate and the axis; what is nearer than 1.4 radii counts as that near.
inline float DiscReach(float coordinate, float in_plane_sq, float radius_sq, float per_unit) {
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
    reach_rows[i] = DiscReach(upwards, across_rows, radius_sq, per_unit);
    reach_columns[i] = DiscReach(to_left, across_columns, radius_sq, per_unit);
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

}  // namespace

FacingPoints FindFacing(const ObjectModel& model, const Eigen::Isometry3f& T_axis_object,
                        float radius, const PixelGrid& grid) {
  const Eigen::Vector3f sensor = T_axis_object.inverse().translation();
  FacingPoints facing;
  for (std::vector<float>* const column : {&facing.planes, &facing.x, &facing.y, &facing.z})
    column->reserve(model.points.size() / 2);
  facing.indices.reserve(model.points.size() / 2);
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const Eigen::Vector3f to_sensor = sensor - model.points[i];
    const float range_sq = to_sensor.squaredNorm();
    const float height = model.normals[i].dot(to_sensor);  // of the sensor over the disc's plane
    const bool faces =
        height > 0.0f && height * height >= kMinFacingCosine * kMinFacingCosine * range_sq;
    if (!faces || range_sq <= radius * radius) continue;
    const Eigen::Vector3f point = T_axis_object * model.points[i];
    facing.indices.push_back(static_cast<int>(i));
    facing.planes.push_back(-height);
    facing.x.push_back(point.x());
    facing.y.push_back(point.y());
    facing.z.push_back(point.z());
  }
  ProjectAll(grid, radius, &facing);
  return facing;
}

}  // namespace rimod
