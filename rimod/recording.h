#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "rimod/scan.h"

namespace rimod {

// Scans round an object, with where the object stands in them.
struct Recording {
  std::string class_name;
  std::vector<Scan> scans;  // in one world (local) frame
  Eigen::Isometry3d T_local_object = Eigen::Isometry3d::Identity();
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();  // m, object frame
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();
};

// A surface given as triangles, object frame, m. Indices must be valid.
struct Mesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

}  // namespace rimod
