#include "rimod/params.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/matchers.h"

namespace rimod {
namespace {

// A real parameter, its name as complaints give it, and values just out of its range.
struct RealField {
  std::string stage, name;
  std::function<double&(PipelineParams&)> field;
  std::vector<double> illegal;
};

struct CountField {
  std::string stage, name;
  std::function<int&(PipelineParams&)> field;
  std::vector<int> illegal;
};

#define REAL(stage, name, ...)                                                                 \
  {                                                                                            \
#stage, #name, [](PipelineParams & p) -> double& { return p.stage.name; }, { __VA_ARGS__ } \
  }
#define COUNT(stage, name, ...)                                                             \
  {                                                                                         \
#stage, #name, [](PipelineParams & p) -> int& { return p.stage.name; }, { __VA_ARGS__ } \
  }

// Of a quota, as the configuration calls it.
#define QUOTA(name, field, type, ...)                                                             \
  {                                                                                               \
    "ranking", #name "_" #field, [](PipelineParams& p) -> type& { return p.ranking.name.field; }, \
    {                                                                                             \
      __VA_ARGS__                                                                                 \
    }                                                                                             \
  }

const std::vector<RealField>& RealFields() {
  static const std::vector<RealField> fields = {
      REAL(range_image, resolution, 0.0, 0.0009, 0.11),
      REAL(range_image, max_resolution, -0.01, 0.11),
      REAL(range_image, min_filled, -0.1, 1.1),
      REAL(range_image, min_range, -0.01),
      REAL(interest_points, harris_k, -0.01, 0.26),
      REAL(interest_points, max_depth_jump, 0.0, -1.0),
      REAL(interest_points, min_strength, -0.1),
      REAL(interest_points, suppression_radius, -0.01),
      REAL(interest_points, cube_side, 0.0, -0.25),
      REAL(interest_points, max_range, 0.0, -1.0),
      REAL(range_patch, support_size, 0.01, 2.1),
      REAL(range_patch, normal_radius, 0.0, 2.1),
      REAL(range_patch, normal_pixels, -0.1, 100.1),
      REAL(range_patch, max_vertical_cosine, -0.1, 1.1),
      REAL(model_surface, point_spacing, 0.001, 0.2),
      REAL(model_surface, box_margin, -0.01, 1.1),
      REAL(model_surface, ground_clearance, -0.01, 1.1),
      REAL(model_surface, normal_radius, 0.001, 0.6),
      REAL(model_surface, see_through, 0.0, -1.0),
      REAL(model_views, min_elevation, -1.5, 1.5),
      REAL(model_views, max_elevation, -1.5, 1.5),
      REAL(model_views, distance, 0.0, -2.0),
      REAL(matching, max_descriptor_distance, 0.0, -1.0),
      REAL(goodsac, min_separation, -0.01),
      REAL(goodsac, distance_tolerance, 0.0, -0.1),
      REAL(goodsac, min_triangle_height, -0.01),
      REAL(goodsac, min_normal_cosine, -1.1, 1.1),
      REAL(goodsac, max_tilt, -0.1, 3.2),
      REAL(goodsac, min_model_spacing, -0.01),
      REAL(goodsac, angle_tolerance, -0.1, 3.2),
      REAL(goodsac, height_tolerance, 0.0, -0.1),
      REAL(matching, min_roughness, -0.01),
      REAL(model_views, outside_gap, 0.0, 0.6),
      REAL(interest_points, bend_step, 0.0, 1.1),
      REAL(pose_refinement, first_gate, 0.0, -0.1),
      REAL(pose_refinement, last_gate, 0.0, -0.1),
      REAL(pose_refinement, damping, 0.0, -0.1),
      REAL(pose_refinement, normal_radius, 0.0, 2.1),
      REAL(model_views, ground_margin, -0.1, 5.1),
      REAL(validation, outside_weight, -0.1, 10.1),
      REAL(validation, outside_depth, 0.0, -0.1),
      REAL(validation, ground_height, -0.1, 10.1),
      REAL(scoring, epsilon, 0.0, -0.1),
      REAL(scoring, penalty, -1.0),
      REAL(scoring, no_return_penalty, -1.0),
      REAL(scoring, gamma, -0.1, 1.1),
      REAL(pruning, radius, -0.1, 10.1),
      REAL(collisions, cell, 0.004, 1.1),
      REAL(collisions, max_share, -0.1, 1.1),
      REAL(validation, min_score, -0.1, 1.1),
      REAL(ranking, min_normal_cosine, -1.1, 1.1),
      REAL(ranking, coarse_epsilon, 0.0, -0.1),
      REAL(ranking, fine_epsilon, 0.0, -0.1),
      REAL(ranking, first_min_share, -0.1, 1.1),
      REAL(ranking, second_min_share, -0.1, 1.1),
      REAL(ranking, min_known, -0.1, 1.1),
      QUOTA(refined, min_score, double, -0.1, 1.1),
      QUOTA(judged, min_score, double, -0.1, 1.1),
      REAL(ranking, min_screened_score, -0.1, 1.1),
      REAL(ranking, min_coarse_pixels, -1.0, 1e7),
      REAL(ranking, min_tilt, -0.1, 3.3),
      REAL(ranking, max_tilt, -0.1, 3.3),
      REAL(ranking, same_distance, 0.0, -0.1),
      REAL(ranking, same_angle, 0.0, -0.1),
      REAL(refinement, coarse_gate, 0.0, -0.1),
      REAL(refinement, fine_gate, 0.0, -0.1),
      REAL(refinement, judged_first_gate, 0.0, -0.1),
      REAL(refinement, judged_last_gate, 0.0, -0.1),
      REAL(refinement, damping, 0.0, -0.1),
      REAL(refinement, tilt_damping, 0.0, -0.1),
      REAL(refinement, upright_tilt, -0.1, 0.6),
      REAL(refinement, min_leaning_odds, 0.9, 1e10),
      REAL(evidence, normal_radius, 0.0, -0.1),
      REAL(evidence, depth_tolerance, 0.0, -0.1),
      REAL(evidence, slope_tolerance, -0.1),
      REAL(evidence, silhouette_gap, 0.0, -0.1),
      REAL(evidence, rim_inset, 0.0, -0.01),
      REAL(evidence, continue_tolerance, 0.0, -0.1),
      REAL(evidence, support_height, 0.0, -0.1),
      REAL(choice, min_probability, -0.1, 1.1),
      REAL(choice, max_explained_share, -0.1, 1.1),
      REAL(choice, same_class_distance, -0.1, 10.1),
      REAL(choice, other_class_distance, -0.1, 10.1),
      REAL(cloud, mount_x, -1001.0, 1001.0),
      REAL(cloud, mount_y, -1001.0, 1001.0),
      REAL(spherical_spin, support_size, 0.01, 2.1),
      REAL(spherical_spin, normal_radius, 0.0, 2.1),
      REAL(spherical_spin, normal_pixels, -0.1, 100.1),
      REAL(cloud, mount_z, -1001.0, 1001.0),
      REAL(cloud, mount_roll, -6.3, 6.3),
      REAL(cloud, mount_pitch, -6.3, 6.3),
      REAL(cloud, mount_yaw, -6.3, 6.3),
      REAL(cloud, max_pose_gap, 0.0, 3601.0),
      REAL(early, period, 0.0, 3601.0),
      REAL(early, max_unseen_share, -0.1, 1.1),
      REAL(early, min_score, -0.1, 1.1),
      REAL(early, same_object_distance, -0.1, 10.1),
  };
  return fields;
}

const std::vector<CountField>& CountFields() {
  static const std::vector<CountField> fields = {
      COUNT(early, min_sightings, 0, 101),
      COUNT(early, max_misses, -1, 101),
      COUNT(interest_points, max_points, 0, -1),
      COUNT(interest_points, max_points_a_cube, -1),
      COUNT(interest_points, harris_window, 1, 16),
      COUNT(range_patch, resolution, 1, 17),
      COUNT(range_patch, min_points, 2),
      COUNT(spherical_spin, resolution, 1, 17),
      COUNT(spherical_spin, dimensions, -1, 256),
      COUNT(spherical_spin, min_points, 2),
      COUNT(model_surface, min_neighbours, 2, 1001),
      COUNT(model_views, azimuths, 0, 361),
      COUNT(model_views, elevations, 0, 31),
      COUNT(model_views, validation_points, 0, 10001),
      COUNT(matching, max_matches, 0, -5),
      COUNT(matching, max_checks, 0),
      COUNT(matching, min_correspondences, -1, 10000001),
      COUNT(goodsac, max_correspondences, 2),
      COUNT(goodsac, max_trials, 0),
      COUNT(goodsac, max_triples, 0),
      COUNT(goodsac, max_poses_a_correspondence, -1),
      COUNT(matching, min_shared_cells, -1, 257),
      COUNT(model_views, outside_points, -1, 10001),
      COUNT(pose_refinement, iterations, -1, 101),
      COUNT(validation, half_trust_pixels, -1),
      COUNT(validation, outside_gap, 0, 11),
      COUNT(scoring, window, -1, 4),
      COUNT(validation, min_pixels, 0),
      COUNT(matching, projected_dimensions, 0, 257),
      COUNT(ranking, first_points, 0),
      COUNT(ranking, second_points, 0, 10001),
      COUNT(ranking, num_models, -1, 1000001),
      COUNT(ranking, full_models, 0, 1000001),
      QUOTA(refined, always, int, -1, 1000000),
      QUOTA(refined, most, int, 0, 1000001),
      QUOTA(judged, always, int, -1, 1000000),
      QUOTA(judged, most, int, 0, 1000001),
      COUNT(refinement, coarse_iterations, -1, 101),
      COUNT(refinement, screening_iterations, -1, 101),
      COUNT(refinement, fine_iterations, -1, 101),
      COUNT(ranking, max_scanned, 0),
  };
  return fields;
}

#undef REAL
#undef COUNT
#undef QUOTA

TEST(PipelineParamsTest, WhatAMethodStartsFromIsLegal) {
  for (const Method method : {Method::kPaper, Method::kDefault}) {
    const PipelineParams params = DefaultParams(method);
    EXPECT_EQ(params.method, method);
    EXPECT_NO_THROW(params.Validate());
  }
}

TEST(PipelineParamsTest, NamesTheRealFieldThatIsOutOfRange) {
  for (const RealField& field : RealFields()) {
    std::vector<double> values = field.illegal;
    values.insert(values.end(), {std::nan(""), HUGE_VAL, -HUGE_VAL});
    for (const double value : values) {
      PipelineParams params;
      field.field(params) = value;
      EXPECT_TRUE(Complains([&] { params.Validate(); }, {field.stage, field.name}))
          << field.stage << ' ' << field.name << ' ' << value;
    }
  }
}

TEST(PipelineParamsTest, NamesTheCountThatIsOutOfRange) {
  for (const CountField& field : CountFields()) {
    for (const int value : field.illegal) {
      PipelineParams params;
      field.field(params) = value;
      EXPECT_TRUE(
          Complains([&] { params.Validate(); }, {field.stage, field.name, std::to_string(value)}));
    }
  }
}

TEST(PipelineParamsTest, ChecksWhatLiesOutsideTheStages) {
  PipelineParams params;
  params.max_reported_hypotheses = 0;
  EXPECT_TRUE(Complains([&] { params.Validate(); }, {"max_reported_hypotheses", "0"}));
  params = PipelineParams();
  params.validation.scoring.epsilon = -1.0;
  EXPECT_TRUE(Complains([&] { params.Validate(); }, {"epsilon"}));
  params = PipelineParams();
  params.descriptor = DescriptorType::kSphericalSpin;
  params.method = Method::kPaper;
  EXPECT_NO_THROW(params.Validate());
  params.method = Method::kDefault;
  EXPECT_TRUE(Complains([&] { params.Validate(); }, {"descriptor", "spherical_spin", "paper"}));
  params = PipelineParams();
  params.sweep.line_duration = 0.0;
  EXPECT_TRUE(Complains([&] { params.Validate(); }, {"line_duration"}));
  params = PipelineParams();
  params.model_views.max_elevation = params.model_views.min_elevation - 0.01;
  EXPECT_TRUE(Complains([&] { params.Validate(); }, {"max_elevation"}));
}

}  // namespace
}  // namespace rimod
