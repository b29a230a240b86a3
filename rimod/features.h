#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace rimod {

// A descriptor's values in steps of kDescriptorUnit; kEmptyCell where no point fell into the cell.
using Descriptor = std::vector<std::int16_t>;
constexpr double kDescriptorUnit = 1e-4;  // m
constexpr std::int16_t kEmptyCell = INT16_MIN;

// What describes the surface around an interest point.
enum class DescriptorType {
  kRangePatch,     // range_patch.h, the paper's (section III-A)
  kSphericalSpin,  // spherical_spin.h, the one that it is compared with (section IV)
};

// A place on a surface.
struct OrientedPoint {
  Eigen::Vector3f position =
      Eigen::Vector3f::Zero();  // m; level sensor frame, or object frame in models
  Eigen::Vector3f normal =
      Eigen::Vector3f::Zero();  // unit, towards the side that was seen; same frame
};

// An interest point with the description of the surface around it (paper, section III-A).
struct Feature : OrientedPoint {
  Descriptor descriptor;
};

// The features of one range image, all with descriptors of one kind.
struct FeatureSet {
  std::string descriptor_kind;  // name and parameters; only equal kinds can be matched
  int descriptor_size = 0;      // values of each descriptor
  std::vector<Feature> features;
};

}  // namespace rimod
