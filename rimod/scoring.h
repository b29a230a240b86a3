#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "rimod/object_model.h"
#include "rimod/range_image.h"

namespace rimod {

struct ScoringParams {
  double epsilon = 0.06;  // m, largest depth difference of a point at its place (eq. 1); > 0
  double penalty = 10.0;  // p of eq. 1, for a point that the laser went through; >= 0
  double no_return_penalty = 0.5;  // for a point where the laser came back without a range; >= 0
  int window = 0;      // pixels around the point's own that may fit it; 0 = its own only, .. 3
  double gamma = 0.3;  // smallest score of a hypothesis (section III-C); 0 .. 1
  void Validate() const;
};

// Eq. 1 as NOTES read it, for a model point at depth d_v where the scene is measured at depth d_s:
// 1 - |d_v - d_s| / epsilon at its place, 0 behind something, -penalty where the laser went
// through.
double PointScore(double d_v, double d_s, const ScoringParams& params);

// The score of a model point (sensor frame) in the image: the best of the window's pixels. Outside
// the image and where nothing was observed the scene says nothing: 0.
double PointScoreInImage(const RangeImage& image, const Eigen::Vector3d& p_sensor,
                         const ScoringParams& params);

// Index of the view whose viewpoint lies nearest to the direction in which the sensor stands.
int NearestView(const ObjectModel& model, const Eigen::Isometry3d& T_sensor_object);

// Eq. 2: the score of a pose by the validation points of the nearest view, 0 .. 1; 0 for a model
// without views or a view without points, and as soon as gamma cannot be reached any more.
double ScorePose(const RangeImage& image, const ObjectModel& model,
                 const Eigen::Isometry3d& T_sensor_object, const ScoringParams& params);

}  // namespace rimod
