#include "rimod/pixel_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rimod {
namespace {

// Of what an image cannot hold: outside of every grid, and its position still an int.
constexpr ImageCoordinates kOutside = {1e3, 1e3};

// How far from a coordinate the silhouette of a ball goes, on the side away from the axis. across:
// the other coordinate; sine: the ball's radius over its distance.
double SilhouetteReach(double coordinate, double across, double sine) {
  // In the plane of this coordinate and the axis the ball is a disc, nearer by what it is aside.
  const double in_plane_sq = 1.0 + coordinate * coordinate;
  const double disc_sine_sq = sine * sine * (in_plane_sq + across * across) / in_plane_sq;
  if (disc_sine_sq >= 1.0) return std::numeric_limits<double>::infinity();
  const double tangent = std::sqrt(disc_sine_sq / (1.0 - disc_sine_sq));
  // tan(a + b) - tan(a)
  const double left_of_pole = 1.0 - std::abs(coordinate) * tangent;
  if (left_of_pole <= 0.0) return std::numeric_limits<double>::infinity();
  return tangent * in_plane_sq / left_of_pole;
}

}  // namespace

Direction DirectionOf(const Eigen::Vector3d& p_sensor) {
  return {std::atan2(p_sensor.y(), p_sensor.x()),
          std::atan2(p_sensor.z(), p_sensor.head<2>().norm())};
}

Eigen::Vector3d UnitVector(const Direction& direction) {
  const double horizontal = std::cos(direction.elevation);
  return {horizontal * std::cos(direction.azimuth), horizontal * std::sin(direction.azimuth),
          std::sin(direction.elevation)};
}

bool PixelGrid::operator==(const PixelGrid& other) const {
  return width == other.width && height == other.height && resolution == other.resolution &&
         left == other.left && top == other.top && projection == other.projection &&
         axis.azimuth == other.axis.azimuth && axis.elevation == other.axis.elevation;
}

Eigen::Matrix3d AxisFromSensor(const PixelGrid& grid) {
  if (grid.projection == Projection::kSpherical) return Eigen::Matrix3d::Identity();
  const double cos_azimuth = std::cos(grid.axis.azimuth), sin_azimuth = std::sin(grid.axis.azimuth);
  const double cos_up = std::cos(grid.axis.elevation), sin_up = std::sin(grid.axis.elevation);
  Eigen::Matrix3d R_axis_sensor;
  R_axis_sensor << cos_up * cos_azimuth, cos_up * sin_azimuth, sin_up,  //
      -sin_azimuth, cos_azimuth, 0.0,                                   //
      -sin_up * cos_azimuth, -sin_up * sin_azimuth, cos_up;
  return R_axis_sensor;
}

ImageCoordinates CoordinatesOf(Projection projection, const Eigen::Vector3d& p_axis) {
  if (projection == Projection::kSpherical) {
    const Direction direction = DirectionOf(p_axis);
    return {direction.azimuth, direction.elevation};
  }
  if (!(p_axis.x() > kMinPinholeCosine * p_axis.norm())) return kOutside;
  return {p_axis.y() / p_axis.x(), p_axis.z() / p_axis.x()};
}

bool CanHold(const PixelGrid& grid, const Eigen::Vector3d& p_sensor) {
  return grid.projection == Projection::kSpherical ||
         UnitVector(grid.axis).dot(p_sensor) > kMinPinholeCosine * p_sensor.norm();
}

PixelPosition Project(const PixelGrid& grid, const Eigen::Vector3d& p_sensor) {
  if (grid.projection == Projection::kSpherical)
    return PositionOf(grid, CoordinatesOf(grid.projection, p_sensor));
  return PositionOf(grid, CoordinatesOf(grid.projection, AxisFromSensor(grid) * p_sensor));
}

PixelPosition ProjectDirection(const PixelGrid& grid, const Direction& direction) {
  if (grid.projection == Projection::kSpherical)
    return PositionOf(grid, {direction.azimuth, direction.elevation});
  return Project(grid, UnitVector(direction));
}

Direction PixelDirection(const PixelGrid& grid, double row, double column) {
  if (grid.projection == Projection::kPinhole) return DirectionOf(PixelBeam(grid, row, column));
  const ImageCoordinates coordinates = CoordinatesAt(grid, row, column);
  return {coordinates.left, coordinates.up};
}

Eigen::Vector3d PixelBeam(const PixelGrid& grid, double row, double column) {
  if (grid.projection == Projection::kSpherical)
    return UnitVector(PixelDirection(grid, row, column));
  const ImageCoordinates coordinates = CoordinatesAt(grid, row, column);
  return AxisFromSensor(grid).transpose() *
         Eigen::Vector3d(1.0, coordinates.left, coordinates.up).normalized();
}

double PixelAngle(const PixelGrid& grid, const Eigen::Vector3d& p_sensor) {
  if (grid.projection == Projection::kSpherical) return grid.resolution;
  const double cosine = UnitVector(grid.axis).dot(p_sensor) / p_sensor.norm();
  return grid.resolution * (cosine > kMinPinholeCosine ? cosine : kMinPinholeCosine);
}

PixelReach PinholeReach(const PixelGrid& grid, const ImageCoordinates& centre, double sine) {
  const double rows = SilhouetteReach(centre.up, centre.left, sine) / grid.resolution;
  const double columns = SilhouetteReach(centre.left, centre.up, sine) / grid.resolution;
  return {std::min(rows, static_cast<double>(grid.height)),
          std::min(columns, static_cast<double>(grid.width))};
}

}  // namespace rimod
