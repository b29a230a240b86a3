#pragma once

#include <Eigen/Core>
#include <string>

#include "rimod/object_model.h"

namespace rimod {

// Models made of exact surface points and normals, without views; object frame, metres.

// A square plate in the plane x = 0 around (0, 0, half its side) whose normals look along +x.
ObjectModel PlateModel(const std::string& name, double side, double spacing);

// A sphere around (0, 0, radius).
ObjectModel SphereModel(const std::string& name, double radius, double spacing);

// The faces of a box that stands on z = 0, its origin at the middle of the bottom.
ObjectModel BoxModel(const std::string& name, const Eigen::Vector3d& size, double spacing);

}  // namespace rimod
