#pragma once

#include <Eigen/Core>
#include <vector>

#include "rimod/features.h"

namespace rimod {

// The directions in which a set of descriptors varies most (principal components): descriptors
// projected onto them are shorter and keep their distances as well as that many values can. Empty
// cells stand at the mean.
class DescriptorProjection {
 public:
  // All of one size; at most that many dimensions.
  DescriptorProjection(const std::vector<const Descriptor*>& descriptors, int dimensions);

  // Values that projected descriptors have; 0 when there were no descriptors.
  int dimensions() const { return static_cast<int>(axes_.rows()); }

  // In kDescriptorUnit like what it came from; values that do not fit are clipped.
  Descriptor Project(const Descriptor& descriptor) const;

 private:
  Eigen::MatrixXf axes_;  // dimensions x descriptor size, rows are unit vectors
};

}  // namespace rimod
