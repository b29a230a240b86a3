#pragma once

#include <Eigen/Core>
#include <optional>

#include "scanner_proc/scene.h"

namespace rimod::simulation {

// Where a ray meets a surface.
struct SurfacePoint {
  double range = 0.0;                                 // along the ray, in lengths of its direction
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // not unit, either side; the ray's frame
};

// The first point at a range within (min_range, max_range) where a ray meets the shape's surface,
// from outside or inside. Origin and direction in the part's frame; the direction need not be unit
// but must not be zero.
std::optional<SurfacePoint> Intersect(const SphereShape& sphere, const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction, double min_range,
                                      double max_range);
std::optional<SurfacePoint> Intersect(const FrustumShape& frustum, const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction, double min_range,
                                      double max_range);

}  // namespace rimod::simulation
