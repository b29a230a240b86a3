#include "io/config_table.h"

namespace rimod {
namespace {

template <typename Enum>
ChoiceOf Choice(Enum* value, std::vector<std::string> names) {
  return {std::move(names), [value] { return static_cast<int>(*value); },
          [value](int number) { *value = static_cast<Enum>(number); }};
}

using Keys = std::vector<ConfigKey>;

// One line a key.
// clang-format off

Keys ScanKeys(PipelineParams* p) {
  SweepParams& s = p->sweep;
  CloudParams& c = p->cloud;
  RangeImageParams& r = p->range_image;
  return {
      {"sweep", "line_duration", &s.line_duration, "s, from a line's first beam to the next line's; > 0"},
      {"sweep", "beams_per_line", &s.beams_per_line, "beams in line_duration; >= 1"},
      {"sweep", "min_range", &s.min_range, "m, nearer readings hit the robot itself; >= 0"},
      {"sweep", "max_range", &s.max_range, "m, readings at or above are beams without a return; > min_range"},
      {"sweep", "reversal_angle_deg", DegreesOf{&s.reversal_angle}, "the tilt must come back this far to end a sweep; > 0"},
      {"sweep", "pause_duration", &s.pause_duration, "s, a gap in the lines or a tilt at rest this long ends a sweep; > 0"},
      {"sweep", "rest_rate_deg", DegreesOf{&s.rest_rate}, "degrees a second, a slower tilt is at rest; >= 0"},
      {"sweep", "min_sweep_angle_deg", DegreesOf{&s.min_sweep_angle}, "a sweep that turned less is incomplete; > 0"},
      {"sweep", "max_missing_share", &s.max_missing_share, "of a sweep's lines, more make it incomplete; 0 .. 1"},
      {"sweep", "max_pose_gap", &s.max_pose_gap, "s, poses farther apart are not interpolated; > 0"},
      {"sweep", "max_buffered_lines", &s.max_buffered_lines, "lines that wait for a pose; >= 1"},
      {"sweep", "max_buffered_poses", &s.max_buffered_poses, "poses that wait for a line; >= 2"},
      {"sweep", "max_lines", &s.max_lines, "a longer sweep is ended as incomplete; >= 1"},

      {"cloud", "mount_x", &c.mount_x, "m, sensor of point clouds in its carrier's frame; -1000 .. 1000"},
      {"cloud", "mount_y", &c.mount_y, "m"},
      {"cloud", "mount_z", &c.mount_z, "m; without a pose channel the height above the floor"},
      {"cloud", "mount_roll_deg", DegreesOf{&c.mount_roll}, "turned about z (yaw), then y (pitch), then x (roll); -360 .. 360"},
      {"cloud", "mount_pitch_deg", DegreesOf{&c.mount_pitch}, "> 0 looks down"},
      {"cloud", "mount_yaw_deg", DegreesOf{&c.mount_yaw}, "> 0 looks left"},
      {"cloud", "max_pose_gap", &c.max_pose_gap, "s, poses farther apart are not interpolated; 0.001 .. 3600"},

      {"range_image", "projection", Choice(&r.projection, {"spherical", "pinhole"}), "pinhole serves cameras that look steeply down; spherical where they see wider than 60 degrees around the middle"},
      {"range_image", "resolution_deg", DegreesOf{&r.resolution}, "of a pixel (paper: 0.4); 0.06 .. 5.7"},
      {"range_image", "max_resolution_deg", DegreesOf{&r.max_resolution}, "sparser scans get larger pixels, up to this; 0 = never .. 5.7"},
      {"range_image", "min_filled", &r.min_filled, ".. the smallest of which this share is observed beside measured ones; 0 .. 1"},
      {"range_image", "min_range", &r.min_range, "m, nearer points belong to the sensor's carrier; >= 0"},
  };
}

Keys FeatureKeys(PipelineParams* p) {
  InterestPointParams& i = p->interest_points;
  RangePatchParams& d = p->range_patch;
  SphericalSpinParams& s = p->spherical_spin;
  return {
      {"interest_points", "measure", Choice(&i.measure, {"harris", "surface_change"}), "what makes a pixel interesting: harris (paper) or surface_change"},
      {"interest_points", "max_points", &i.max_points, "the strongest are kept; >= 1"},
      {"interest_points", "harris_window", &i.harris_window, "pixels, side of the window of the gradients; 2 .. 15"},
      {"interest_points", "harris_k", &i.harris_k, "Harris' trace weight; 0 .. 0.25"},
      {"interest_points", "max_depth_jump", &i.max_depth_jump, "m, larger differences to a neighbour count as this much; > 0"},
      {"interest_points", "bend_step", &i.bend_step, "m, bends are measured over this distance (surface_change); > 0"},
      {"interest_points", "min_strength", &i.min_strength, "weaker points are left out; >= 0"},
      {"interest_points", "suppression_radius", &i.suppression_radius, "m, only the strongest point within is kept; >= 0"},
      {"interest_points", "cube_side", &i.cube_side, "m, of the cubes of space in which points are counted; > 0"},
      {"interest_points", "max_points_a_cube", &i.max_points_a_cube, "the strongest in a cube are kept; 0 = all"},
      {"interest_points", "max_range", &i.max_range, "m, farther points are left out; > 0"},

      {"range_patch", "resolution", &d.resolution, "cells a side (paper: 8); 2 .. 16"},
      {"range_patch", "support_size", &d.support_size, "m, side of the square (paper: 0.35); 0.02 .. 2"},
      {"range_patch", "normal_radius", &d.normal_radius, "m, the normal is that of the points this near; 0.01 .. 2"},
      {"range_patch", "normal_pixels", &d.normal_pixels, ".. but at least this many pixels, for far surfaces; 0 .. 100"},
      {"range_patch", "min_points", &d.min_points, "measured points needed for a normal; >= 3"},
      {"range_patch", "mask_empty_cells", &d.mask_empty_cells, "cells without a point are not compared, else they count as the mean"},
      {"range_patch", "max_vertical_cosine", &d.max_vertical_cosine, "normals nearer to the vertical have no horizontal of their own; 0 .. 1"},

      {"spherical_spin", "resolution", &s.resolution, "bins of distance and of height (paper: 5); 2 .. 16"},
      {"spherical_spin", "support_size", &s.support_size, "m, diameter and height of the cylinder (paper: 0.6); 0.02 .. 2"},
      {"spherical_spin", "dimensions", &s.dimensions, "lowest frequencies that spin images are compressed to; 0 = not compressed .. 255"},
      {"spherical_spin", "normal_radius", &s.normal_radius, "m, the normal is that of the points this near; 0.01 .. 2"},
      {"spherical_spin", "normal_pixels", &s.normal_pixels, ".. but at least this many pixels, for far surfaces; 0 .. 100"},
      {"spherical_spin", "min_points", &s.min_points, "measured points needed for a normal; >= 3"},
  };
}

Keys ModelKeys(PipelineParams* p) {
  ModelSurfaceParams& s = p->model_surface;
  ModelViewParams& v = p->model_views;
  return {
      {"model_surface", "point_spacing", &s.point_spacing, "m, between the model's surface points; 0.002 .. 0.1"},
      {"model_surface", "box_margin", &s.box_margin, "m, points this far outside the box still belong to the object; 0 .. 1"},
      {"model_surface", "ground_clearance", &s.ground_clearance, "m, lower points are taken for the floor; 0 .. 1"},
      {"model_surface", "normal_radius", &s.normal_radius, "m, the normal is that of the points this near; 0.005 .. 0.5"},
      {"model_surface", "see_through", &s.see_through, "m, a scan that measured this far behind a point saw through it; > 0"},
      {"model_surface", "min_neighbours", &s.min_neighbours, "points within normal_radius, fewer are outliers; 3 .. 1000"},

      {"model_views", "azimuths", &v.azimuths, "viewpoints around the object; 1 .. 360"},
      {"model_views", "elevations", &v.elevations, "rings of viewpoints; 1 .. 30"},
      {"model_views", "min_elevation_deg", DegreesOf{&v.min_elevation}, "of the lowest ring, seen from the object's centre; -80 .. 80"},
      {"model_views", "max_elevation_deg", DegreesOf{&v.max_elevation}, "of the highest ring; >= min_elevation_deg"},
      {"model_views", "distance", &v.distance, "m, from the object's centre, at least 1.5 diameters; > 0"},
      {"model_views", "validation_points", &v.validation_points, "a view (paper: n = 100); 1 .. 10000"},
      {"model_views", "outside_points", &v.outside_points, "beside the silhouette, a view; 0 .. 10000"},
      {"model_views", "ground_margin", &v.ground_margin, "m, ground shown around the box; 0 = the object alone .. 5"},
      {"model_views", "outside_gap", &v.outside_gap, "m, from the silhouette to its outside points; 0.005 .. 0.5"},
  };
}

Keys MatchingKeys(PipelineParams* p) {
  MatchingParams& m = p->matching;
  GoodsacParams& g = p->goodsac;
  return {
      {"matching", "max_descriptor_distance", &m.max_descriptor_distance, "m, root mean square a cell (paper: d_max); > 0"},
      {"matching", "max_matches", &m.max_matches, "nearest model features kept for one of the scene (default method: of each model); >= 1"},
      {"matching", "max_checks", &m.max_checks, "model features looked at for one of the scene (default method: of each model); >= 1"},
      {"matching", "min_correspondences", &m.min_correspondences, "of a model: where the scene has few features each keeps more matches (default method); >= 0"},
      {"matching", "min_shared_cells", &m.min_shared_cells, "cells that two descriptors must share to be compared anew over these; 0 = empty cells count as the mean .. 256"},
      {"matching", "min_roughness", &m.min_roughness, "m, distances count relative to the patch's roughness, but at least this; 0 = as they are"},
      {"matching", "projected_dimensions", &m.projected_dimensions, "lowest frequencies that descriptors are shortened to (default method); 1 .. 256"},

      {"goodsac", "max_correspondences", &g.max_correspondences, "the best ones, that triples are made of (paper: n); >= 3"},
      {"goodsac", "min_model_spacing", &g.min_model_spacing, "m, of a scene feature's correspondences to nearer model features only the best counts; 0 = all"},
      {"goodsac", "max_trials", &g.max_trials, "transformations computed for a model; >= 1"},
      {"goodsac", "max_triples", &g.max_triples, "triples looked at, most of them rejected early; >= 1"},
      {"goodsac", "min_separation", &g.min_separation, "m, between the features of a triple; >= 0"},
      {"goodsac", "distance_tolerance", &g.distance_tolerance, "m, a distance in the scene against the model's; > 0"},
      {"goodsac", "min_triangle_height", &g.min_triangle_height, "m, triples on a line are left out; >= 0"},
      {"goodsac", "min_normal_cosine", &g.min_normal_cosine, "transformed normals against the scene's; -1 = not tested .. 1"},
      {"goodsac", "max_tilt_deg", DegreesOf{&g.max_tilt}, "of the object's z-axis from the vertical; 180 = not tested"},
      {"goodsac", "angle_tolerance_deg", DegreesOf{&g.angle_tolerance}, "angles of a pair's normals in the scene against the model's; 180 = not tested"},
      {"goodsac", "height_tolerance", &g.height_tolerance, "m, a pair's difference in height in the scene against the model's; > 0, large = not tested"},
      {"goodsac", "max_poses_a_correspondence", &g.max_poses_a_correspondence, "that have it as their worst member; 0 = no limit"},
  };
}

Keys ScoringKeys(const std::string& section, ScoringParams* s) {
  return {
      {section, "epsilon", &s->epsilon, "m, largest depth difference of a point at its place (eq. 1); > 0"},
      {section, "penalty", &s->penalty, "for a point that the laser went through (eq. 1: p); >= 0"},
      {section, "no_return_penalty", &s->no_return_penalty, "for a point where the laser came back without a range; >= 0"},
      {section, "window", &s->window, "pixels around the point's own that may fit it; 0 .. 3"},
      {section, "gamma", &s->gamma, "smallest score of a hypothesis (section III-C); 0 .. 1"},
  };
}

Keys RejectionKeys(PipelineParams* p) {
  return {
      {"pruning", "radius", &p->pruning.radius, "of the model's diameter: only the best hypothesis within is kept; 0 .. 10"},

      {"pose_refinement", "iterations", &p->pose_refinement.iterations, "of ICP for the candidates that pruning leaves; 0 = none .. 100"},
      {"pose_refinement", "first_gate", &p->pose_refinement.first_gate, "m, farther pairs are left out at first ..; > 0"},
      {"pose_refinement", "last_gate", &p->pose_refinement.last_gate, "m, .. and in the end; > 0"},
      {"pose_refinement", "damping", &p->pose_refinement.damping, "of the points' number, keeps what they do not determine; > 0"},
      {"pose_refinement", "normal_radius", &p->pose_refinement.normal_radius, "m, a scene normal is that of the points this near; 0.01 .. 2"},

      {"collisions", "cell", &p->collisions.cell, "m, spacing of the low-resolution clouds; 0.005 .. 1"},
      {"collisions", "max_share", &p->collisions.max_share, "of the smaller cloud's points that may lie in the other; 0 .. 1"},

      {"validation", "min_score", &p->validation.min_score, "candidates below are false positives; 0 .. 1"},
      {"validation", "min_pixels", &p->validation.min_pixels, "of the model in the image, fewer say nothing; >= 1"},
      {"validation", "half_trust_pixels", &p->validation.half_trust_pixels, "pixels of the model at which the score counts half; 0 = it always counts .. 1000000"},
      {"validation", "before_collisions", &p->validation.before_collisions, "candidates are validated before collisions are looked for"},
      {"validation", "outside_weight", &p->validation.outside_weight, "of the silhouette's outside where the scene goes on, subtracted; 0 = not looked at .. 10"},
      {"validation", "outside_gap", &p->validation.outside_gap, "pixels between the silhouette and those compared; 1 .. 10"},
      {"validation", "outside_depth", &p->validation.outside_depth, "m, the scene goes on when its depth differs by less; > 0"},
      {"validation", "ground_height", &p->validation.ground_height, "m, lower points beside an object are what it stands on; 0 .. 10"},
  };
}

Keys DefaultMethodKeys(PipelineParams* p) {
  RankingParams& r = p->ranking;
  RefinementParams& f = p->refinement;
  EvidenceParams& e = p->evidence;
  ChoiceParams& c = p->choice;
  return {
      {"ranking", "min_normal_cosine", &r.min_normal_cosine, "of a correspondence's normals after the turn; -1 .. 1"},
      {"ranking", "min_tilt_deg", DegreesOf{&r.min_tilt}, "normals of a correspondence this far apart after the turn give a tilted pose, too ..; >= 0"},
      {"ranking", "max_tilt_deg", DegreesOf{&r.max_tilt}, ".. up to this; 0 = none"},
      {"ranking", "coarse_epsilon", &r.coarse_epsilon, "m, depth difference of a point at its place before refinement; > 0"},
      {"ranking", "fine_epsilon", &r.fine_epsilon, "m, after it; > 0"},
      {"ranking", "first_points", &r.first_points, "looked at first, hopeless hypotheses are given up then ..; >= 1"},
      {"ranking", "first_min_share", &r.first_min_share, ".. of those with nothing in front so many must be at their place; 0 .. 1"},
      {"ranking", "second_points", &r.second_points, "the same after so many points ..; >= 1"},
      {"ranking", "second_min_share", &r.second_min_share, ".. 0 .. 1"},
      {"ranking", "min_known", &r.min_known, "of the points that must have nothing in front; 0 .. 1"},
      {"ranking", "num_models", &r.num_models, "that share the work, for matchers that have a part of them; 0 = those loaded"},
      {"ranking", "full_models", &r.full_models, "with more models each gets less work, by this over their number to the power of 0.65; >= 1"},
      {"ranking", "max_scanned", &r.max_scanned, "best of each model: among these different poses are looked for; >= 1"},
      {"ranking", "refined_always", &r.refined.always, "of each model: so many of the best different poses are refined ..; >= 0"},
      {"ranking", "refined_most", &r.refined.most, ".. and up to this; >= refined_always"},
      {"ranking", "refined_min_score", &r.refined.min_score, ".. if their score is at least this; 0 .. 1"},
      {"ranking", "judged_always", &r.judged.always, "of each model: so many of the best refined poses are judged ..; >= 0"},
      {"ranking", "judged_most", &r.judged.most, ".. and up to this; >= judged_always"},
      {"ranking", "judged_min_score", &r.judged.min_score, ".. if their score is at least this; 0 .. 1"},
      {"ranking", "min_screened_score", &r.min_screened_score, "those that a first look finds less probable are not looked at closely; 0 .. 1"},
      {"ranking", "min_coarse_pixels", &r.min_coarse_pixels, "that a model spans, from which every other row and column is compared before, which gives up what is ten times less probable still; 0 .. 1e6 (never)"},
      {"ranking", "same_distance", &r.same_distance, "m, poses nearer than this ..; > 0"},
      {"ranking", "same_angle_deg", DegreesOf{&r.same_angle}, ".. and turned by less are the same; > 0"},

      {"refinement", "coarse_iterations", &f.coarse_iterations, "of every hypothesis that is ranked; 0 .. 100"},
      {"refinement", "screening_iterations", &f.screening_iterations, "of the candidates that are judged, before a first look; 0 .. 100"},
      {"refinement", "fine_iterations", &f.fine_iterations, "of those that pass it; 0 .. 100"},
      {"refinement", "coarse_gate", &f.coarse_gate, "m, farther pairs are left out at first ..; > 0"},
      {"refinement", "fine_gate", &f.fine_gate, "m, .. and in the end; > 0"},
      {"refinement", "judged_first_gate", &f.judged_first_gate, "m, the same before judging, at first ..; > 0"},
      {"refinement", "judged_last_gate", &f.judged_last_gate, "m, .. and in the end; > 0"},
      {"refinement", "damping", &f.damping, "of the points' number, keeps what they do not determine; > 0"},
      {"refinement", "tilt_damping", &f.tilt_damping, "the same for the tilt from the vertical; > 0"},
      {"refinement", "upright_tilt_deg", DegreesOf{&f.upright_tilt}, "what leans less is judged upright, too, and counts as upright ..; 0 = nothing .. 28"},
      {"refinement", "min_leaning_odds", &f.min_leaning_odds, ".. unless leaning it is so many times as probable (odds); >= 1"},

      {"evidence", "normal_radius", &e.normal_radius, "m, a scene normal is that of the points this near; > 0"},
      {"evidence", "depth_tolerance", &e.depth_tolerance, "m, measured against rendered depth on a surface seen head-on; > 0"},
      {"evidence", "slope_tolerance", &e.slope_tolerance, "of a pixel's size times the surface's slope, added to it; >= 0"},
      {"evidence", "max_tolerance", &e.max_tolerance, "m, on surfaces seen at a flat angle; >= depth_tolerance"},
      {"evidence", "slight_difference", &e.slight_difference, "m, depth differences up to this are slight; > max_tolerance"},
      {"evidence", "silhouette_gap", &e.silhouette_gap, "m, how far beside the silhouette is looked; > 0"},
      {"evidence", "rim_inset", &e.rim_inset, "m, how far inside it its rim is looked at; > 0"},
      {"evidence", "continue_tolerance", &e.continue_tolerance, "m, a surface going on past the silhouette; > 0"},
      {"evidence", "support_height", &e.support_height, "m, around the object's bottom; > 0"},

      {"choice", "min_probability", &c.min_probability, "smallest score of a detection; 0 .. 1"},
      {"choice", "max_explained_share", &c.max_explained_share, "of its pixels that better ones may explain; 0 .. 1"},
      {"choice", "same_class_distance", &c.same_class_distance, "of the diameter, between centres of two of one class; 0 .. 10"},
      {"choice", "other_class_distance", &c.other_class_distance, "of the smaller diameter, of two classes; 0 .. 10"},
  };
}

Keys ResultKeys(PipelineParams* p) {
  EarlyParams& e = p->early;
  return {
      {"early", "period", &e.period, "s of a sweep after which it is looked at anew; 0.05 .. 3600"},
      {"early", "max_unseen_share", &e.max_unseen_share, "of an object's near side that was not swept yet; 0 .. 1"},
      {"early", "min_score", &e.min_score, "of a detection to be told early; 0 .. 1"},
      {"early", "min_sightings", &e.min_sightings, ".. in so many looks in a row; 1 .. 100"},
      {"early", "max_misses", &e.max_misses, "looks in a row without an object before it is withdrawn; 0 .. 100"},
      {"early", "same_object_distance", &e.same_object_distance, "of the diameter, between detections of one object; 0 .. 10"},

      {"result", "max_reported_hypotheses", &p->max_reported_hypotheses, "in a result and its message; 1 .. 500"},
  };
}

Keys BusKeys(BusParams* b) {
  return {
      {"bus", "max_megabytes_per_second", &b->max_megabytes_per_second, "large messages are sent at this rate at most; 0.1 .. 10000"},
      {"bus", "max_waiting_scans", &b->max_waiting_scans, "complete scans that wait, further ones push the oldest out; 1 .. 1000"},
      {"bus", "idle_time", &b->idle_time, "s, the assembler ends a sweep when nothing came for so long; 0.05 .. 3600"},
      {"bus", "quiet_time", &b->quiet_time, "s, the assembler sends a scan when no line came for so long, and again if the sweep goes on; 0.01 .. 3600"},
      {"bus", "scan_ahead", &b->scan_ahead, "what a sweep grows by is sent at once, so that the extractor has the scan at the sweep's end"},
      {"bus", "join_patience", &b->join_patience, "s, wait for missing parts of a scan; 0.1 .. 3600"},
      {"bus", "shard_patience", &b->shard_patience, "s, the fuser waits so long after the first answer to a scan; 0.1 .. 3600"},
  };
}

// clang-format on

}  // namespace

std::vector<ConfigKey> ConfigTable(Configuration* configuration) {
  PipelineParams* const p = &configuration->pipeline;
  Keys table = {
      {"", "method", Choice(&p->method, {"paper", "default"}),
       "paper (as literal as it works) or default (the best that we know): the values that "
       "hold where this file says nothing"},
      {"", "descriptor", Choice(&p->descriptor, {"range_patch", "spherical_spin"}),
       "of the surface around interest points: range_patch or spherical_spin (method paper only)"}};
  for (const Keys& keys : {ScanKeys(p), FeatureKeys(p), ModelKeys(p), MatchingKeys(p),
                           ScoringKeys("scoring", &p->scoring), RejectionKeys(p),
                           ScoringKeys("validation_scoring", &p->validation.scoring),
                           DefaultMethodKeys(p), ResultKeys(p), BusKeys(&configuration->bus)}) {
    table.insert(table.end(), keys.begin(), keys.end());
  }
  return table;
}

std::vector<SectionCheck> SectionChecks() {
  using C = const Configuration&;
  return {
      {"", [](C c) { CheckDescriptor(c.pipeline); }},
      {"sweep", [](C c) { c.pipeline.sweep.Validate(); }},
      {"cloud", [](C c) { c.pipeline.cloud.Validate(); }},
      {"range_image", [](C c) { c.pipeline.range_image.Validate(); }},
      {"interest_points", [](C c) { c.pipeline.interest_points.Validate(); }},
      {"range_patch", [](C c) { c.pipeline.range_patch.Validate(); }},
      {"spherical_spin", [](C c) { c.pipeline.spherical_spin.Validate(); }},
      {"model_surface", [](C c) { c.pipeline.model_surface.Validate(); }},
      {"model_views", [](C c) { c.pipeline.model_views.Validate(); }},
      {"matching", [](C c) { c.pipeline.matching.Validate(); }},
      {"goodsac", [](C c) { c.pipeline.goodsac.Validate(); }},
      {"scoring", [](C c) { c.pipeline.scoring.Validate(); }},
      {"pruning", [](C c) { c.pipeline.pruning.Validate(); }},
      {"pose_refinement", [](C c) { c.pipeline.pose_refinement.Validate(); }},
      {"collisions", [](C c) { c.pipeline.collisions.Validate(); }},
      {"validation_scoring", [](C c) { c.pipeline.validation.scoring.Validate(); }},
      {"validation", [](C c) { c.pipeline.validation.Validate(); }},
      {"ranking", [](C c) { c.pipeline.ranking.Validate(); }},
      {"refinement", [](C c) { c.pipeline.refinement.Validate(); }},
      {"evidence", [](C c) { c.pipeline.evidence.Validate(); }},
      {"choice", [](C c) { c.pipeline.choice.Validate(); }},
      {"early", [](C c) { c.pipeline.early.Validate(); }},
      {"result", [](C c) { c.pipeline.Validate(); }},
      {"bus", [](C c) { c.bus.Validate(); }},
  };
}

}  // namespace rimod
