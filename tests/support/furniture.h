#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "rimod/recording.h"
#include "tests/support/ray_caster.h"

namespace rimod {

// Things to be found, made of boxes and balls; object frame, metres.
struct Furniture {
  std::string name;
  std::vector<BoxShape> parts;
  std::vector<SphereShape> balls;
  Eigen::Vector3d box_min, box_max;
};

// An armchair with one armrest and a stool with a leg, a side and a handle: nothing about them is
// symmetric.
Furniture Armchair();
Furniture Stool();
// A pile of balls and boxes of all sizes: hardly a piece of its surface is like another.
Furniture Sculpture();

// Adds it to the world, the object frame at the pose.
void Place(const Furniture& furniture, const Eigen::Isometry3d& T_local_object, World* world);

// Eight scans from 2 m around it on a floor, without noise.
Recording Record(const Furniture& furniture);

}  // namespace rimod
