#pragma once

#include "rimod/cloud_placer.h"
#include "rimod/early_params.h"
#include "rimod/evidence.h"
#include "rimod/false_positive_rejection.h"
#include "rimod/goodsac.h"
#include "rimod/hypothesis_ranking.h"
#include "rimod/interest_points.h"
#include "rimod/matching.h"
#include "rimod/model_surface.h"
#include "rimod/model_views.h"
#include "rimod/range_image.h"
#include "rimod/range_patch.h"
#include "rimod/refinement.h"
#include "rimod/scoring.h"
#include "rimod/spherical_spin.h"
#include "rimod/sweep_assembler.h"

namespace rimod {

enum class Method {
  kPaper,    // as literal as it works
  kDefault,  // the best that we know
};

// Refinement of the candidates that pruning leaves (not in the paper).
struct PoseRefinementParams {
  int iterations = 0;          // of ICP with the nearest view's validation points; 0 = none .. 100
  double first_gate = 0.15;    // m, farther pairs are left out at first ..; > 0
  double last_gate = 0.05;     // m, .. and in the end; > 0
  double damping = 0.02;       // of the points' number, keeps what they do not determine; > 0
  double normal_radius = 0.1;  // m, a scene normal is that of the points this near; > 0
  void Validate() const;
};

// Which of the judged candidates become detections (default method).
struct ChoiceParams {
  double min_probability = 0.36;     // smallest score of a detection; 0 .. 1
  double max_explained_share = 0.4;  // of its pixels may be explained by better ones; 0 .. 1
  double same_class_distance =
      0.4;  // of the diameter, between centres of two of one class; 0 .. 10
  double other_class_distance = 0.2;  // .. of two classes, of the smaller diameter; 0 .. 10
  void Validate() const;
};

// Everything that can be set, one struct a stage. io/config reads it from YAML.
struct PipelineParams {
  Method method = Method::kDefault;
  DescriptorType descriptor = DescriptorType::kRangePatch;  // spherical_spin: method paper only
  SweepParams sweep;
  CloudParams cloud;
  RangeImageParams range_image;
  InterestPointParams interest_points;
  RangePatchParams range_patch;
  SphericalSpinParams spherical_spin;
  ModelSurfaceParams model_surface;
  ModelViewParams model_views;
  MatchingParams matching;
  GoodsacParams goodsac;
  ScoringParams scoring;
  PruningParams pruning;
  PoseRefinementParams pose_refinement;
  CollisionParams collisions;
  ValidationParams validation;
  RankingParams ranking;
  RefinementParams refinement;
  EvidenceParams evidence;
  ChoiceParams choice;
  EarlyParams early;
  int max_reported_hypotheses = 200;  // in a result and its message; 1 .. 500
  void Validate() const;              // all of the above
};

// Throws std::invalid_argument when the method cannot use the descriptor.
void CheckDescriptor(const PipelineParams& params);

// The parameters that a method starts from.
PipelineParams DefaultParams(Method method);

}  // namespace rimod
