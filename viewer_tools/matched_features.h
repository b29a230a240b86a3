#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "rimod/features.h"
#include "rimod/object_model.h"

namespace rimod {

// Indices, rising, of the scene's features that a pose explains: the model has a feature at that
// place (8 cm), with a normal alike (30 degrees) and a descriptor within max_descriptor_distance
// (m, root mean square over the cells that both have). Empty where the descriptors are of another
// kind than the model's.
std::vector<int> MatchedFeatures(const FeatureSet& features, const ObjectModel& model,
                                 const Eigen::Isometry3d& T_sensor_object);

}  // namespace rimod
