#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "rimod/execution.h"
#include "rimod/object_model.h"
#include "rimod/params.h"
#include "rimod/scan.h"

namespace rimod {

// Scans round an object, with where the object stands in them.
struct Recording {
  std::string class_name;
  std::vector<Scan> scans;                                               // in one world (local) frame
  Eigen::Isometry3d T_local_object = Eigen::Isometry3d::Identity();
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();                     // m, object frame
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();
};

// A surface given as triangles, object frame, m. Indices must be valid.
struct Mesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

// Joins the scans, cuts the object out of its surroundings, cleans and evens its surface and computes
// its views (paper, sections III-A, III-C, V). Throws std::invalid_argument when hardly any point is
// inside the box.
ObjectModel BuildModel(const Recording& recording, const PipelineParams& params,
                       const Execution& execution);

// From points of the object alone, in the object frame, seen from all around or from some sides only.
ObjectModel BuildModelFromPoints(const std::string& class_name,
                                 const std::vector<Eigen::Vector3f>& points,
                                 const PipelineParams& params, const Execution& execution);

// From a mesh in the object frame: its surface is sampled evenly.
ObjectModel BuildModelFromMesh(const std::string& class_name, const Mesh& mesh,
                               const PipelineParams& params, const Execution& execution);

}  // namespace rimod
