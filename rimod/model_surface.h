#pragma once

#include <Eigen/Core>
#include <vector>

#include "rimod/execution.h"
#include "rimod/recording.h"

namespace rimod {

struct ModelSurfaceParams {
  double point_spacing = 0.01;  // m, between the model's surface points; 0.002 .. 0.1
  double box_margin =
      0.02;  // m, points this far outside the box still belong to the object; 0 .. 1
  double ground_clearance = 0.02;  // m, points lower than this are taken for the floor; 0 .. 1
  double normal_radius = 0.03;     // m, a normal is that of the points this near; 0.005 .. 0.5
  double see_through = 0.05;  // m, a scan that measured this far behind a point saw through it; > 0
  int min_neighbours = 4;     // points within normal_radius, fewer are outliers; 3 .. 1000
  void Validate() const;
};

// A surface: points evenly spread with the normals of the side that was seen.
struct Surface {
  double point_spacing = 0.0;  // m, between neighbouring points: the wanted one, or more where
                               // the source was sparser
  std::vector<Eigen::Vector3f> points;   // m
  std::vector<Eigen::Vector3f> normals;  // unit
};

// The object's surface from a recording, object frame: points inside the box and above the ground,
// without those that other scans looked through (flying pixels), joined and evened.
Surface SurfaceOfRecording(const Recording& recording, const ModelSurfaceParams& params,
                           const Execution& execution);

// The surface of an object's points whose seen side is not known: every point is there twice, once
// a side. Points that are not finite are left out.
Surface SurfaceOfPoints(const std::vector<Eigen::Vector3f>& points,
                        const ModelSurfaceParams& params);

// Points sampled evenly on a mesh, both sides of every triangle (its orientation is not trusted).
Surface SurfaceOfMesh(const Mesh& mesh, const ModelSurfaceParams& params);

}  // namespace rimod
