#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "rimod/object_model.h"
#include "rimod/refinement.h"
#include "rimod/scene.h"

namespace rimod {

// Fast scoring of very many pose hypotheses with the validation points of the nearest view (paper,
// section III-C) and its outside points, for sorting out all but the best.

// How many of a model's hypotheses go on: the best ones anyway, more of them if they are probable.
struct ModelQuota {
  int always = 1;          // the best so many, whatever their score; >= 0
  int most = 1;            // .. and up to this; >= always, >= 1
  double min_score = 0.0;  // .. with at least this score; 0 .. 1
};

struct RankingParams {
  double min_normal_cosine = 0.7;  // of a correspondence's normals after the turn; -1 .. 1
  // rad; a correspondence whose normals stay this far apart after the turn gives a tilted pose,
  // too, in which they agree; max_tilt 0: none
  double min_tilt = 0.17;
  double max_tilt = 0.5;
  double coarse_epsilon =
      0.2;                     // m, depth difference of a point at its place before refinement; > 0
  double fine_epsilon = 0.05;  // m, after it; > 0
  // Hopeless hypotheses are given up after their first points, and after some more:
  int first_points = 12;           // >= 1
  double first_min_share = 0.5;    // of those with nothing in front at their place; 0 .. 1
  int second_points = 48;          // >= 1
  double second_min_share = 0.58;  // 0 .. 1
  double min_known = 0.15;         // of them with nothing in front; 0 .. 1
  // How much work goes into a model: with more than full_models of them it grows slower than their
  // number, so that each gets less of the matches of a feature and of the quotas, and a first look
  // gives up more.
  int num_models = 0;     // models that share it; 0 = those of the database
  int full_models = 7;    // >= 1
  int max_scanned = 800;  // best of each model: among these different poses are looked for; >= 1
  ModelQuota refined{120, 240, 0.002};
  ModelQuota judged{8, 40, 0.01};
  // Those that a first look finds less probable are not looked at closely; 0 .. 1
  double min_screened_score = 0.003;
  // .. after a look at every other row and column, where the model spans so many pixels, that gives
  // up what is ten times less probable still; 0 .. 1e6, which is never
  double min_coarse_pixels = 40.0;
  double same_distance = 0.05;  // m, poses nearer than this ..; > 0
  double same_angle = 0.26;     // rad, .. and turned by less are the same; > 0
  void Validate() const;
};

// A view's points as the scoring and refinement want them.
struct RankingView {
  Eigen::Vector3f direction =
      Eigen::Vector3f::Zero();  // unit, from the model's centre, object frame
  SurfaceSample surface;
  PointColumns points;   // of the surface
  PointColumns outside;  // beside its silhouette
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

// What is known of a hypothesis: what the view's points say of its pose, as shares of their number,
// and where it comes from.
struct RankingFigures {
  float at_place = 0.0f;        // sum of 1 - |depth difference| / epsilon
  float hits = 0.0f;            // points within epsilon
  float looked_through = 0.0f;  // points in front of what was measured
  float known = 0.0f;           // points that nothing is in front of
  float agreeing = 0.0f;        // sum of the cosines between measured and model normals at the hits
  float goes_on = 0.0f;         // of the outside points: the scene is at their depth
  float jumps = 0.0f;           // of the outside points: the scene is deeper
  float pixels_across = 0.0f;   // that the model's diameter spans
  float tilt = 0.0f;            // rad, of the object's z-axis
  float descriptor_distance = 0.0f;  // m, of the correspondence that it comes from
  float votes = 1.0f;                // hypotheses of the same pose, with itself
};

// A pose of a model that the default method considers.
struct Hypothesis {
  int model = 0;  // in the database
  Eigen::Isometry3f T_sensor_object = Eigen::Isometry3f::Identity();
  double score = 0.0;
  RankingFigures figures;
  int origin = -1;  // its number among those that are refined; -1: none yet
};

// Compares poses with one scene, one after the other; of use to one thread.
class ViewComparison {
 public:
  // The scene and the parameters must outlive it. Epsilon: m, depth difference of a hit.
  ViewComparison(const Scene& scene, double epsilon, const RankingParams& params);

  // Sets the figures of the view's points, leaves the others. False for hopeless poses: too few of
  // the first points at their place.
  bool Compare(const RankingModel& model, const Eigen::Isometry3f& T_sensor_object,
               RankingFigures* figures);

 private:
  void Look(const PointColumns& points, const Eigen::Isometry3f& T_sensor_object, std::size_t begin,
            std::size_t end);
  void ComparePoints(const RankingView& view, const Eigen::Isometry3f& T_sensor_object,
                     std::size_t begin, std::size_t end, RankingFigures* figures);
  void CompareOutside(const RankingView& view, const Eigen::Isometry3f& T_sensor_object,
                      RankingFigures* figures);

  const Scene& scene_;
  const float epsilon_;  // m
  const RankingParams& params_;
  ProjectedPoints projected_;  // of the points last looked at
  std::vector<float> behind_;  // m, how far behind them the scene is
};

}  // namespace rimod
