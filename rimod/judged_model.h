#pragma once

#include <Eigen/Core>
#include <vector>

#include "rimod/object_model.h"
#include "rimod/refinement.h"

namespace rimod {

// A model's surface for judging poses: thinned, and which space it fills.
class JudgedModel {
 public:
  explicit JudgedModel(const ObjectModel& model);

  const ObjectModel& model() const { return *model_; }
  // The surface about evenly thinned, for refinement, and thinner still for a first one.
  const SurfaceSample& sample() const { return sample_; }
  const SurfaceSample& coarse_sample() const { return coarse_sample_; }
  // Model whose points are thinned so far that their discs still close the surface for pixels of
  // this size (m).
  const ObjectModel& Thinned(double pixel_size) const;
  // Whether a point (object frame) lies on the surface, to about 3 cm; outside the box: false.
  bool OnSurface(const Eigen::Vector3f& p_object) const;

 private:
  const ObjectModel* model_;
  SurfaceSample sample_, coarse_sample_;
  std::vector<ObjectModel> thinned_;  // by rising spacing; the first is the model itself
  Eigen::Vector3f grid_origin_;
  Eigen::Vector3i grid_size_;
  std::vector<bool> near_surface_;  // by cell: bits, for models are many
};

}  // namespace rimod
