#include "scanner_proc/curved_shapes.h"

#include <algorithm>
#include <cmath>

namespace rimod::simulation {
namespace {

// Real solutions of a t^2 + 2 b t + c = 0, without cancellation; the smaller first.
struct Roots {
  int number = 0;
  double values[2] = {0.0, 0.0};
};

Roots SolveQuadratic(double a, double b, double c) {
  Roots roots;
  if (a == 0.0) {
    if (b != 0.0) roots = {1, {-c / (2.0 * b), 0.0}};
    return roots;
  }
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return roots;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  const double first = q / a;
  const double second = q != 0.0 ? c / q : first;
  roots = {2, {std::min(first, second), std::max(first, second)}};
  return roots;
}

// Keeps the nearest of the points that it is shown.
class Nearest {
 public:
  Nearest(double min_range, double max_range) : min_range_(min_range), max_range_(max_range) {}

  bool Beats(double range) const { return range > min_range_ && range < max_range_; }
  void Set(double range, const Eigen::Vector3d& normal) {
    max_range_ = range;
    point_ = SurfacePoint{range, normal};
    found_ = true;
  }
  std::optional<SurfacePoint> point() const {
    if (!found_) return std::nullopt;
    return point_;
  }

 private:
  double min_range_;
  double max_range_;
  bool found_ = false;
  SurfacePoint point_;
};

void IntersectDisc(double height, double radius, const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction, Nearest* nearest) {
  if (direction.z() == 0.0) return;
  const double range = (height - origin.z()) / direction.z();
  if (!nearest->Beats(range)) return;
  const Eigen::Vector2d point = (origin + range * direction).head<2>();
  if (point.squaredNorm() <= radius * radius) nearest->Set(range, Eigen::Vector3d::UnitZ());
}

}  // namespace

std::optional<SurfacePoint> Intersect(const SphereShape& sphere, const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction, double min_range,
                                      double max_range) {
  const Eigen::Vector3d from_centre = origin - Eigen::Vector3d(0.0, 0.0, sphere.radius);
  const Roots roots = SolveQuadratic(direction.squaredNorm(), from_centre.dot(direction),
                                     from_centre.squaredNorm() - sphere.radius * sphere.radius);
  Nearest nearest(min_range, max_range);
  for (int i = 0; i < roots.number; ++i) {
    const double range = roots.values[i];
    if (nearest.Beats(range)) nearest.Set(range, from_centre + range * direction);
  }
  return nearest.point();
}

// The mantle is x^2 + y^2 = r(z)^2 with r(z) = bottom_radius + slope * z, for 0 <= z <= height.
std::optional<SurfacePoint> Intersect(const FrustumShape& frustum, const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction, double min_range,
                                      double max_range) {
  const double slope = (frustum.top_radius - frustum.bottom_radius) / frustum.height;
  const double radius = frustum.bottom_radius + slope * origin.z();  // at the origin's height
  const double radius_rate = slope * direction.z();                  // along the ray
  const Roots roots =
      SolveQuadratic(direction.head<2>().squaredNorm() - radius_rate * radius_rate,
                     origin.head<2>().dot(direction.head<2>()) - radius * radius_rate,
                     origin.head<2>().squaredNorm() - radius * radius);
  Nearest nearest(min_range, max_range);
  for (int i = 0; i < roots.number; ++i) {
    const double range = roots.values[i];
    const Eigen::Vector3d point = origin + range * direction;
    // The other half of the double cone lies outside these heights.
    if (!nearest.Beats(range) || point.z() < 0.0 || point.z() > frustum.height) continue;
    nearest.Set(range,
                {point.x(), point.y(), -slope * (frustum.bottom_radius + slope * point.z())});
  }
  IntersectDisc(0.0, frustum.bottom_radius, origin, direction, &nearest);
  IntersectDisc(frustum.height, frustum.top_radius, origin, direction, &nearest);
  return nearest.point();
}

}  // namespace rimod::simulation
