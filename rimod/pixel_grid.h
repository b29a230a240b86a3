#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace rimod {

struct Direction {
  double azimuth = 0.0;    // rad, from x towards y (left)
  double elevation = 0.0;  // rad, upwards from the horizontal plane
};

// Direction of a point in the level sensor frame; p must not be zero.
Direction DirectionOf(const Eigen::Vector3d& p_sensor);
// Unit vector of a direction.
Eigen::Vector3d UnitVector(const Direction& direction);

// How a range image lays out directions; docs/conventions.md.
enum class Projection : std::uint8_t {
  kSpherical,  // by azimuth and elevation
  kPinhole,    // on a plane across an optical axis
};

// A direction as an image lays it out, growing to the left and upwards: spherical azimuth and
// elevation, rad; pinhole the tangents on the plane at distance 1 along the axis.
struct ImageCoordinates {
  double left = 0.0;
  double up = 0.0;
};

// Where the pixels of a range image look, in the level sensor frame; docs/conventions.md. The
// centre of pixel (row, column) has the image coordinates left - (column + 0.5) * resolution,
// top - (row + 0.5) * resolution.
struct PixelGrid {
  int width = 0;            // columns
  int height = 0;           // rows
  double resolution = 0.0;  // image coordinates per pixel, > 0: rad, pinhole on the axis
  double left = 0.0;        // image coordinate of column 0's left edge
  double top = 0.0;         // image coordinate of row 0's upper edge
  Projection projection = Projection::kSpherical;
  Direction axis = {};  // of a pinhole image; zero of a spherical one

  int size() const { return width * height; }
  bool Contains(int row, int column) const {
    return row >= 0 && row < height && column >= 0 && column < width;
  }
  bool operator==(const PixelGrid& other) const;
};

// Pinhole images hold nothing farther off their axis: there a pixel would see next to nothing.
constexpr double kMinPinholeCosine = 0.25881904510252074;  // 75 degrees

// Level sensor frame to the frame of the grid's axis: x along it, y to the left and level, z
// upwards in the image. Straight up or down the axis' azimuth tells which way is left. The identity
// for a spherical grid.
Eigen::Matrix3d AxisFromSensor(const PixelGrid& grid);

// A point's image coordinates, from its own in the frame of the axis. What a pinhole image cannot
// hold gives coordinates far outside of every grid.
ImageCoordinates CoordinatesOf(Projection projection, const Eigen::Vector3d& p_axis);

// Whether a direction has a place in the plane that the grid is a part of: all have in a spherical
// one, in a pinhole's those less than 75 degrees off the axis.
bool CanHold(const PixelGrid& grid, const Eigen::Vector3d& p_sensor);

struct PixelPosition {
  double row = 0.0;  // pixel centres at k + 0.5: floor gives the index
  double column = 0.0;
};
inline PixelPosition PositionOf(const PixelGrid& grid, const ImageCoordinates& coordinates) {
  return {(grid.top - coordinates.up) / grid.resolution,
          (grid.left - coordinates.left) / grid.resolution};
}
// What the grid cannot hold (CanHold) has a position far outside of it.
PixelPosition Project(const PixelGrid& grid, const Eigen::Vector3d& p_sensor);
PixelPosition ProjectDirection(const PixelGrid& grid, const Direction& direction);

inline ImageCoordinates CoordinatesAt(const PixelGrid& grid, double row, double column) {
  return {grid.left - column * grid.resolution, grid.top - row * grid.resolution};
}
// Where a position in the image looks; the inverse of Project. A spherical grid that goes on past
// straight behind gives azimuths beyond half a turn.
Direction PixelDirection(const PixelGrid& grid, double row, double column);
// The same as a unit vector.
Eigen::Vector3d PixelBeam(const PixelGrid& grid, double row, double column);

// Spacing of neighbouring pixels' points, over range (rad): on a surface across the beams
// (spherical) or across the axis (pinhole).
inline double PixelAngle(const PixelGrid& grid, int row, int column) {
  if (grid.projection == Projection::kSpherical) return grid.resolution;
  const ImageCoordinates at = CoordinatesAt(grid, row + 0.5, column + 0.5);
  return grid.resolution / std::sqrt(1.0 + at.left * at.left + at.up * at.up);
}
// The same where a point is seen; pinhole: of one that the grid cannot hold, at 75 degrees.
double PixelAngle(const PixelGrid& grid, const Eigen::Vector3d& p_sensor);

// Pixels from the position that a ball's centre is seen at to the farthest that sees the ball.
struct PixelReach {
  double rows = 0.0;
  double columns = 0.0;
};
// Of a ball in a pinhole image; sine: its radius over its distance from the sensor. At most the
// grid's size, also where the ball reaches the plane through the pinhole.
PixelReach PinholeReach(const PixelGrid& grid, const ImageCoordinates& centre, double sine);

}  // namespace rimod
