#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "rimod/object_model.h"
#include "rimod/range_image.h"

namespace rimod {

struct ModelViewParams {
  int azimuths = 16;   // viewpoints around the object; 1 .. 360
  int elevations = 3;  // rings of viewpoints; 1 .. 30
  double min_elevation =
      0.09;  // rad, of the lowest ring, seen from the object's centre; -1.4 .. 1.4
  double max_elevation = 0.79;  // rad, of the highest ring; >= min_elevation
  double distance = 2.5;        // m, from the object's centre, at least 1.5 diameters; > 0
  int validation_points = 100;  // n of the paper, a view; 1 .. 10000
  int outside_points = 40;      // beside the silhouette, a view; 0 .. 10000
  double ground_margin =
      0.0;  // m, ground shown around the box in the views; 0 = the object alone, .. 5
  double outside_gap = 0.04;  // m, from the silhouette to its outside points; 0.005 .. 0.5
  void Validate() const;
  std::string Kind() const;  // all of it in words: equal when the views are
};

// Where the virtual views are taken from: rings around the middle of the box, object frame, m.
std::vector<Eigen::Vector3d> Viewpoints(const ObjectModel& model, const ModelViewParams& params);

// The range image of the model alone from a viewpoint, level, x towards the object's centre; pixels
// beside it are "no return". With ground_margin > 0 (m) the object stands on a plane at its box's
// bottom that reaches that far around the box. T_local_sensor takes the image to the object frame.
RangeImage RenderView(const ObjectModel& model, const Eigen::Vector3d& viewpoint, double resolution,
                      double ground_margin);

// Sets the view's validation points (spread evenly over the visible surface) with their normals and
// its outside points, up to params.validation_points and params.outside_points.
void SampleViewPoints(const ObjectModel& model, double resolution, const ModelViewParams& params,
                      ModelView* view);

}  // namespace rimod
