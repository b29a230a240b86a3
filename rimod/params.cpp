#include "rimod/params.h"

#include <stdexcept>

#include "rimod/check.h"

namespace rimod {
namespace {

// The paper's method with the deviations that make it work (docs/algorithm.md). Each stage is set
// in full, so that the defaults may go their own way.
PipelineParams PaperParams() {
  PipelineParams params;
  params.method = Method::kPaper;

  params.interest_points.measure = InterestMeasure::kSurfaceChange;
  params.interest_points.max_points = 1200;
  params.interest_points.max_depth_jump = 0.3;
  params.interest_points.bend_step = 0.05;
  params.interest_points.min_strength = 1e-6;
  params.interest_points.suppression_radius = 0.05;
  params.range_patch.resolution = 8;
  params.range_patch.support_size = 0.35;
  params.range_patch.normal_radius = 0.1;
  params.range_patch.normal_pixels = 2.0;
  params.range_patch.mask_empty_cells = true;
  params.model_views.azimuths = 12;
  params.model_views.elevations = 2;
  params.model_views.min_elevation = 0.09;
  params.model_views.max_elevation = 0.6;
  params.model_views.distance = 2.5;
  params.model_views.validation_points = 100;
  params.model_views.ground_margin = 0.3;

  params.matching.max_descriptor_distance = 0.05;
  params.matching.max_matches = 60;
  params.matching.max_checks = 800;
  params.matching.min_shared_cells = 24;
  params.matching.min_roughness = 0.01;
  params.goodsac.max_correspondences = 3000;
  params.goodsac.min_model_spacing = 0.05;
  params.goodsac.max_trials = 20000;
  params.goodsac.max_triples = 10'000'000;
  params.goodsac.min_separation = 0.1;
  params.goodsac.distance_tolerance = 0.05;
  params.goodsac.min_triangle_height = 0.05;
  params.goodsac.min_normal_cosine = 0.8;
  params.goodsac.max_tilt = 0.35;
  params.goodsac.angle_tolerance = 0.5;
  params.goodsac.height_tolerance = 0.05;
  params.goodsac.max_poses_a_correspondence = 5;

  params.scoring.epsilon = 0.1;
  params.scoring.penalty = 1.0;
  params.scoring.no_return_penalty = 0.5;
  params.scoring.window = 1;
  params.scoring.gamma = 0.3;
  params.pruning.radius = 0.3;
  params.collisions.cell = 0.05;
  params.collisions.max_share = 0.15;
  params.pose_refinement.iterations = 6;
  params.pose_refinement.first_gate = 0.15;
  params.pose_refinement.last_gate = 0.05;
  params.pose_refinement.damping = 0.02;
  params.pose_refinement.normal_radius = 0.1;
  params.validation.scoring = params.scoring;
  params.validation.scoring.epsilon = 0.06;
  params.validation.scoring.penalty = 10.0;
  params.validation.min_score = 0.2;
  params.validation.half_trust_pixels = 100;
  params.validation.min_pixels = 20;
  params.validation.before_collisions = true;
  params.validation.outside_weight = 2.0;
  params.validation.outside_gap = 2;
  params.validation.outside_depth = 0.2;
  params.validation.ground_height = 0.05;
  return params;
}

// Our own method: many features and matches, sorted out later.
PipelineParams OwnParams() {
  PipelineParams params;
  params.method = Method::kDefault;
  params.range_image.max_resolution = 0.035;
  params.interest_points.measure = InterestMeasure::kSurfaceChange;
  params.interest_points.max_points = 2000;
  params.interest_points.suppression_radius = 0.045;
  params.interest_points.max_points_a_cube = 8;
  params.range_patch.normal_pixels = 2.0;
  params.range_patch.mask_empty_cells = false;
  params.model_views.ground_margin = 0.5;
  params.matching.max_descriptor_distance = 0.07;
  params.matching.max_matches = 5;
  params.matching.max_checks = 60;
  params.matching.min_correspondences = 2500;
  return params;
}

}  // namespace

void PoseRefinementParams::Validate() const {
  CheckWithin("pose_refinement iterations", iterations, 0, 100);
  CheckWithin("pose_refinement first_gate", first_gate, 1e-3, 10.0);
  CheckWithin("pose_refinement last_gate", last_gate, 1e-3, 10.0);
  CheckWithin("pose_refinement damping", damping, 1e-6, 10.0);
  CheckWithin("pose_refinement normal_radius", normal_radius, 0.01, 2.0);
}

void ChoiceParams::Validate() const {
  CheckWithin("choice min_probability", min_probability, 0.0, 1.0);
  CheckWithin("choice max_explained_share", max_explained_share, 0.0, 1.0);
  CheckWithin("choice same_class_distance", same_class_distance, 0.0, 10.0);
  CheckWithin("choice other_class_distance", other_class_distance, 0.0, 10.0);
}

void PipelineParams::Validate() const {
  sweep.Validate();
  cloud.Validate();
  range_image.Validate();
  interest_points.Validate();
  range_patch.Validate();
  spherical_spin.Validate();
  model_surface.Validate();
  model_views.Validate();
  matching.Validate();
  goodsac.Validate();
  scoring.Validate();
  pruning.Validate();
  pose_refinement.Validate();
  collisions.Validate();
  validation.Validate();
  ranking.Validate();
  refinement.Validate();
  evidence.Validate();
  choice.Validate();
  early.Validate();
  CheckWithin("max_reported_hypotheses", max_reported_hypotheses, 1, 500);
  CheckDescriptor(*this);
}

void CheckDescriptor(const PipelineParams& params) {
  if (params.method == Method::kDefault && params.descriptor != DescriptorType::kRangePatch)
    throw std::invalid_argument(
        "descriptor is spherical_spin, which only method paper can use: what method default has "
        "learnt is about range_patch");
}

PipelineParams DefaultParams(Method method) {
  return method == Method::kPaper ? PaperParams() : OwnParams();
}

}  // namespace rimod
