#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "rimod/object_model.h"
#include "rimod/refinement.h"
#include "rimod/scene.h"

namespace rimod {

// Fast scoring of very many pose hypotheses with the validation points of the nearest view (paper,
// section III-C) and its outside points, for sorting out all but the best.

struct RankingParams {
  double min_normal_cosine = 0.7;  // of a correspondence's normals after the turn; -1 .. 1
  double coarse_epsilon =
      0.2;                     // m, depth difference of a point at its place before refinement; > 0
  double fine_epsilon = 0.05;  // m, after it; > 0
  double see_through = 0.5;    // what a point costs that the laser went through; >= 0
  double outside = 1.0;        // what an outside point costs where the surface goes on; >= 0
  int first_points = 20;       // looked at first; hopeless hypotheses are given up then; >= 1
  double first_min_share = 0.25;  // of them must be at their place; 0 .. 1
  double pixels_half = 60.0;  // squared pixels across the object that make a score count half; >= 0
  int max_refined = 1500;     // best hypotheses of different poses that are refined; >= 1
  int max_judged = 200;       // best of them after refinement that are judged; >= 1
  double same_distance = 0.05;  // m, poses nearer than this ..; > 0
  double same_angle = 0.26;     // rad, .. and turned by less are the same; > 0
  void Validate() const;
};

// A view's points as the scoring and refinement want them.
struct RankingView {
  Eigen::Vector3f direction =
      Eigen::Vector3f::Zero();  // unit, from the model's centre, object frame
  SurfaceSample surface;
  std::vector<Eigen::Vector3f> outside;
  double area_share = 0.0;  // of the visible surface's solid angle times distance squared, m^2
};

struct RankingModel {
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();
  std::vector<RankingView> views;
};

RankingModel MakeRankingModel(const ObjectModel& model);

// Pixels that a model's diameter spans at a pose.
double PixelsAcross(const Scene& scene, const ObjectModel& model,
                    const Eigen::Isometry3d& T_sensor_object);

// The view nearest to where the sensor stands; -1 without views.
int NearestView(const RankingModel& model, const Eigen::Isometry3f& T_sensor_object);

// What the view's points say of a pose, as shares of their number.
struct RankingFigures {
  double at_place = 0.0;        // sum of 1 - |depth difference| / epsilon
  double hits = 0.0;            // points within epsilon
  double looked_through = 0.0;  // points in front of what was measured
  double known = 0.0;           // points that nothing is in front of
  double agreeing = 0.0;        // sum of the cosines between measured and model normals at the hits
  double goes_on = 0.0;         // of the outside points: the scene is at their depth
  double jumps = 0.0;           // of the outside points: the scene is deeper
};

// Nothing for hopeless poses: too few of the first points at their place.
std::optional<RankingFigures> CompareViewPoints(const Scene& scene, const RankingModel& model,
                                                const Eigen::Isometry3f& T_sensor_object,
                                                double epsilon, const RankingParams& params);

// Score of a pose, at most 1: points at their place, less those that were looked through and
// outside points where the surface goes on. 0 for hopeless ones.
double RankingScore(const Scene& scene, const RankingModel& model,
                    const Eigen::Isometry3f& T_sensor_object, double epsilon,
                    const RankingParams& params);

}  // namespace rimod
