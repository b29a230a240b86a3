#include "rimod/pinhole_axis.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rimod {
namespace {

using Beams = std::vector<Eigen::Vector3d>;  // unit vectors, level sensor frame

constexpr double kMinCosine = 0.5;  // 60 degrees: the tangents' pixels are then four times as dense

Beams BeamsOf(const Scan& scan, double min_range) {
  const Eigen::Isometry3d T_sensor_local = scan.T_local_sensor.inverse();
  Beams beams;
  beams.reserve(scan.points.size() + scan.no_return_directions.size());
  for (const Eigen::Vector3f& p_local : scan.points) {
    const Eigen::Vector3d p_sensor = T_sensor_local * p_local.cast<double>();
    const double range = p_sensor.norm();
    if (range >= min_range && range > 0.0) beams.emplace_back(p_sensor / range);
  }
  for (const Eigen::Vector3f& beam_local : scan.no_return_directions)
    beams.emplace_back((T_sensor_local.linear() * beam_local.cast<double>()).normalized());
  return beams;
}

// Middle of the beams' bounding box: smallest and largest do not depend on their order or number.
Eigen::Vector3d BoxMiddle(const Beams& beams) {
  Eigen::Vector3d low = beams.front(), high = beams.front();
  for (const Eigen::Vector3d& beam : beams) {
    low = low.cwiseMin(beam);
    high = high.cwiseMax(beam);
  }
  return 0.5 * (low + high);
}

Eigen::Matrix3d AxisFrame(const Direction& axis) {
  PixelGrid grid;
  grid.projection = Projection::kPinhole;
  grid.axis = axis;
  return AxisFromSensor(grid);
}

// The axis through the middle of the angles that the beams reach to the left and right, up and down
// of the one given; nothing when one is farther off than an image can hold.
std::optional<Direction> Centred(const Direction& axis, const Beams& beams) {
  const Eigen::Matrix3d R_axis_sensor = AxisFrame(axis);
  double left = -1e3, right = 1e3, top = -1e3, bottom = 1e3;  // tangents
  for (const Eigen::Vector3d& beam : beams) {
    const Eigen::Vector3d p_axis = R_axis_sensor * beam;
    if (!(p_axis.x() > kMinPinholeCosine)) return std::nullopt;
    const ImageCoordinates at = CoordinatesOf(Projection::kPinhole, p_axis);
    left = std::max(left, at.left);
    right = std::min(right, at.left);
    top = std::max(top, at.up);
    bottom = std::min(bottom, at.up);
  }
  const Eigen::Vector3d middle(1.0, std::tan(0.5 * (std::atan(left) + std::atan(right))),
                               std::tan(0.5 * (std::atan(top) + std::atan(bottom))));
  return DirectionOf(R_axis_sensor.transpose() * middle);
}

Direction InWholeDegrees(const Direction& axis) {
  constexpr double kDegree = 3.14159265358979323846 / 180.0;
  constexpr double kVertical = 88.0;  // degrees
  const double elevation = std::round(axis.elevation / kDegree);
  if (std::abs(elevation) >= kVertical) return {0.0, std::copysign(90.0, elevation) * kDegree};
  return {std::round(axis.azimuth / kDegree) * kDegree, elevation * kDegree};
}

}  // namespace

std::optional<Direction> PinholeAxis(const Scan& scan, double min_range) {
  constexpr int kRounds = 3;
  constexpr double kShortest = 0.1;  // of a middle of unit vectors: they look everywhere
  const Beams beams = BeamsOf(scan, min_range);
  if (beams.empty()) return std::nullopt;
  const Eigen::Vector3d middle = BoxMiddle(beams);
  if (!(middle.norm() > kShortest)) return std::nullopt;
  std::optional<Direction> axis = DirectionOf(middle);
  for (int round = 0; round < kRounds && axis; ++round) axis = Centred(*axis, beams);
  if (!axis) return std::nullopt;
  const Direction rounded = InWholeDegrees(*axis);
  const Eigen::Vector3d along = UnitVector(rounded);
  const bool all_near = std::all_of(beams.begin(), beams.end(), [&](const Eigen::Vector3d& beam) {
    return along.dot(beam) >= kMinCosine;
  });
  return all_near ? std::optional<Direction>(rounded) : std::nullopt;
}

}  // namespace rimod
