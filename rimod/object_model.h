#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "rimod/features.h"

namespace rimod {

// A virtual view of a model (paper, sections III-A and III-C).
struct ModelView {
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();  // m, object frame
  std::vector<Feature> features;                        // object frame
  std::vector<Eigen::Vector3f> validation_points;       // m, object frame
  std::vector<Eigen::Vector3f> validation_normals;  // unit, object frame, one a validation point
  // m, object frame: just beside the silhouette, at the depth of its edge. Where the object stands
  // the scene does not go on there.
  std::vector<Eigen::Vector3f> outside_points;
};

// Everything known of an object. Object frame: origin at the middle of the bounding box's bottom, z
// up.
struct ObjectModel {
  std::string name;                                   // class name
  std::string source;                                 // what it was built from, for people
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();  // m, object frame
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();
  double point_spacing = 0.0;            // m, between neighbouring surface points
  std::vector<Eigen::Vector3f> points;   // m, object frame, the surface evenly sampled
  std::vector<Eigen::Vector3f> normals;  // unit, outward, one a point
  std::string descriptor_kind;           // of the views' features
  int descriptor_size = 0;
  std::vector<ModelView> views;

  double Diameter() const { return (box_max - box_min).norm(); }
};

// True for 1 .. 64 letters, digits, '_', '-' or '.', not starting with '.': safe in file names, on
// a terminal and in JSON.
bool IsValidModelName(const std::string& name);

// Throws std::invalid_argument saying what is wrong: name, numbers not finite or beyond 1000 m,
// lists of different lengths, descriptors of another size, box with min > max.
void ValidateModel(const ObjectModel& model);

}  // namespace rimod
