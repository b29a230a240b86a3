#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "scanner_proc/scene.h"

namespace rimod::simulation {

struct Ray {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      // m, scene frame
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  // unit
};

// Where a ray first meets a surface.
struct Hit {
  double range = 0.0;          // m, > 0
  double cos_incidence = 0.0;  // between ray and surface normal, 0 .. 1
  double reflectivity = 0.0;   // of the part that was hit
  std::size_t object = 0;      // index into the objects given
};

// Finds what rays hit first among the parts of objects (Embree). Embree finds the surface; the
// range is computed anew in double precision, so that it is exact. May be used from several
// threads.
class RayCaster {
 public:
  // The objects are copied as far as needed. Throws std::runtime_error when Embree fails.
  explicit RayCaster(const std::vector<SceneObject>& objects);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  // Nothing when the ray meets nothing within max_range. Surfaces nearer than 1 mm are not seen.
  std::optional<Hit> Cast(const Ray& ray, double max_range) const;

 private:
  struct Surfaces;
  std::unique_ptr<Surfaces> surfaces_;
};

}  // namespace rimod::simulation
