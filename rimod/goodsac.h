#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <vector>

#include "rimod/features.h"
#include "rimod/matching.h"

namespace rimod {

struct GoodsacParams {
  int max_correspondences = 200;  // n of the paper: the best ones that triples are made of; >= 3
  // m, of a scene feature's correspondences only the best is kept of those whose model features lie
  // nearer to each other than this: one place seen in several views counts once; 0 = all are kept
  double min_model_spacing = 0.0;
  int max_trials = 20000;             // transformations computed for a model; >= 1
  int max_triples = 1500000;          // triples looked at, most of them rejected early; >= 1
  double min_separation = 0.1;        // m, between the features of a triple; >= 0
  double distance_tolerance = 0.05;   // m, a distance in the scene against the model's; > 0
  double min_triangle_height = 0.05;  // m, triples on a line are left out; >= 0
  double min_normal_cosine =
      0.8;  // normals after the transformation against the scene's; -1 .. 1, -1 = not tested
  double max_tilt = 0.35;  // rad, of the object's z-axis from the vertical; pi = not tested
  // rad, between two features' normals and between each normal and the line that joins the two:
  // an angle in the scene against the model's; 0 .. pi, pi = not tested
  double angle_tolerance = 3.14159265358979;
  // m, how much higher one feature of a pair is than the other, in the scene against the model's:
  // objects stand upright; > 0, large = not tested
  double height_tolerance = 1000.0;
  int max_poses_a_correspondence =
      0;  // that have it as their worst member, more are not looked for; 0 = no limit
  void Validate() const;
};

// The triples (i, j, k) of [0, count) in GOODSAC's order (paper, Algorithm 1 as NOTES read it:
// (0,1,2) (0,1,3) (0,2,3) (1,2,3) (0,1,4) ..): every triple of the best k comes before any with a
// worse one. visit returns false to stop.
void VisitTriples(int count, const std::function<bool(int i, int j, int k)>& visit);

// Candidate poses T_sensor_object from triples of the best correspondences of one model (paper,
// section III-B), in the order of the triples.
std::vector<Eigen::Isometry3d> CandidatePoses(std::vector<Correspondence> correspondences,
                                              const std::vector<Feature>& scene_features,
                                              const std::vector<const Feature*>& model_features,
                                              const GoodsacParams& params);

// The same by RANSAC (Fischler and Bolles), to measure what the order is worth: of the same
// correspondences' triples that pass the same early rejections each is as likely as any other in
// each draw, with replacement. max_triples counts draws, max_poses_a_correspondence is not looked
// at. Equal seeds give equal poses.
std::vector<Eigen::Isometry3d> RandomCandidatePoses(
    std::vector<Correspondence> correspondences, const std::vector<Feature>& scene_features,
    const std::vector<const Feature*>& model_features, const GoodsacParams& params,
    std::uint32_t seed);

}  // namespace rimod
