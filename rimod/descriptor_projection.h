#pragma once

#include <Eigen/Core>

#include "rimod/features.h"

namespace rimod {

// Descriptors shortened to their lowest spatial frequencies (two-dimensional cosine transform,
// orthonormal): nearby cells resemble each other, so a few values keep most of the distance between
// two. The axes are the same for all models: what is found of one does not depend on which others
// are looked for. Empty cells stand at the mean.
class DescriptorProjection {
 public:
  // Of patches of resolution x resolution cells onto at most so many dimensions, without the
  // constant part, which descriptors do not have.
  DescriptorProjection(int resolution, int dimensions);

  // Values that projected descriptors have.
  int dimensions() const { return static_cast<int>(axes_.rows()); }

  // In kDescriptorUnit like what it came from; values that do not fit are clipped. Empty for a
  // descriptor of another size.
  Descriptor Project(const Descriptor& descriptor) const;

 private:
  Eigen::MatrixXf axes_;  // dimensions x descriptor size, rows are unit vectors
};

}  // namespace rimod
