#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "rimod/candidates.h"
#include "rimod/object_model.h"
#include "rimod/point_tree.h"
#include "rimod/range_image.h"
#include "rimod/scoring.h"
#include "rimod/surface_rendering.h"

namespace rimod {

// Rejection of false positives (paper, section III-D): the best of a local area, no collisions
// between neighbours, and the same range image as rendered.

// Falling score; ties by model, then position, so that the order is unique.
bool BetterCandidate(const Candidate& a, const Candidate& b);

struct PruningParams {
  double radius =
      0.3;  // of the model's diameter: of one model only the best within it is kept; 0 .. 10
  void Validate() const;
};

// The candidates that are the best of their model in their area, best first.
std::vector<Candidate> PruneToLocalBest(std::vector<Candidate> candidates,
                                        const std::vector<ObjectModel>& models,
                                        const PruningParams& params);

struct CollisionParams {
  double cell = 0.05;       // m, spacing of the low-resolution clouds; 0.005 .. 1
  double max_share = 0.15;  // of the smaller cloud's points within a cell of the other's; 0 .. 1
  void Validate() const;
};

// A model's low-resolution cloud in a kd-tree.
class CollisionShape {
 public:
  CollisionShape(const ObjectModel& model, double cell);

  const std::vector<Eigen::Vector3d>& points() const { return tree_.points(); }  // m, object frame
  const Eigen::Vector3d& centre() const { return centre_; }  // m, middle of the model's box
  double radius() const { return radius_; }  // m, of the ball around it that holds all
  // Whether a point of the cloud is nearer to p_object than distance.
  bool HasPointWithin(const Eigen::Vector3d& p_object, double distance) const;

 private:
  PointTree tree_;
  Eigen::Vector3d centre_;
  double radius_ = 0.0;
};

// The candidates that collide with no better one, best first; given best first.
std::vector<Candidate> RejectCollisions(const std::vector<Candidate>& candidates,
                                        const std::vector<CollisionShape>& shapes,
                                        const CollisionParams& params);

struct ValidationParams {
  ScoringParams scoring;   // for the pixel-by-pixel comparison
  double min_score = 0.4;  // candidates below are false positives; 0 .. 1
  int min_pixels = 20;     // of the model in the image, fewer say nothing; >= 1
  // Pixels of the model in the image at which the score counts half, since few pixels fit anywhere:
  // it is multiplied by n / (n + half_trust_pixels); 0 .. 1000000, 0 = not done.
  int half_trust_pixels = 0;
  // Candidates are validated before collisions are looked for, which then keep the one that
  // validation scored best.
  bool before_collisions = false;
  // Weight of the share of the pixels along the outside of the model's silhouette where the scene
  // goes on at the model's depth, as it does where a model lies in a larger surface; subtracted
  // from the score; 0 .. 10, 0 = not looked at.
  double outside_weight = 0.0;
  int outside_gap = 2;         // pixels between the silhouette and those compared; 1 .. 10
  double outside_depth = 0.1;  // m, the scene goes on when its depth differs by less; > 0
  double ground_height =
      0.05;  // m, lower points beside an object are what it stands on and not compared; 0 .. 10
  void Validate() const;
};

// What lies along the outside of a rendered silhouette.
struct SilhouetteSurroundings {
  int compared = 0;   // pixels
  int continued = 0;  // of these: the scene goes on at the model's depth
};
SilhouetteSurroundings LookAround(const RangeImage& image, const RenderedModel& rendered,
                                  const Eigen::Isometry3d& T_sensor_object,
                                  const ValidationParams& params);

// Score of a candidate by comparing the image with the model rendered at its pose, pixel by pixel;
// 0 when fewer than min_pixels of the model would be seen.
double ValidatePose(const RangeImage& image, const ObjectModel& model,
                    const Eigen::Isometry3d& T_sensor_object, const ValidationParams& params);

}  // namespace rimod
