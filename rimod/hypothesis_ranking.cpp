#include "rimod/hypothesis_ranking.h"

#include <algorithm>
#include <cmath>

#include "rimod/check.h"

namespace rimod {
namespace {

struct Tally {
  float at_place = 0.0f;  // sum of 1 - |difference| / epsilon
  int hits = 0;
  int looked_through = 0;
  int known = 0;  // points where the scene says something and nothing is in front
};

void Count(const Scene& scene, const Eigen::Vector3f& p, float epsilon, Tally* tally) {
  const int pixel = scene.PixelOf(p);
  if (pixel < 0) return;
  const float range = scene.range(pixel);
  if (range == 0.0f) return;
  const float behind = range - p.norm();
  if (behind < -epsilon) return;  // occluded
  ++tally->known;
  if (behind > epsilon) {
    ++tally->looked_through;
    return;
  }
  tally->at_place += 1.0f - std::abs(behind) / epsilon;
  ++tally->hits;
}

bool GoesOn(const Scene& scene, const Eigen::Vector3f& p, float epsilon) {
  const int pixel = scene.PixelOf(p);
  if (pixel < 0) return false;
  const float range = scene.range(pixel);
  return range > 0.0f && std::abs(range - p.norm()) <= epsilon;
}

}  // namespace

void RankingParams::Validate() const {
  CheckWithin("ranking coarse_epsilon", coarse_epsilon, 1e-3, 10.0);
  CheckWithin("ranking fine_epsilon", fine_epsilon, 1e-3, 10.0);
  CheckWithin("ranking see_through", see_through, 0.0, 1e6);
  CheckWithin("ranking outside", outside, 0.0, 1e6);
  CheckWithin("ranking first_points", first_points, 1, 10000);
  CheckWithin("ranking first_min_share", first_min_share, 0.0, 1.0);
  CheckWithin("ranking pixels_half", pixels_half, 0.0, 1e6);
}

RankingModel MakeRankingModel(const ObjectModel& model) {
  RankingModel ranking;
  const Eigen::Vector3d centre = 0.5 * (model.box_min + model.box_max);
  ranking.centre = centre.cast<float>();
  for (const ModelView& view : model.views) {
    RankingView ranking_view;
    ranking_view.direction = (view.viewpoint - centre).normalized().cast<float>();
    ranking_view.surface = {view.validation_points, view.validation_normals};
    ranking_view.outside = view.outside_points;
    ranking.views.push_back(std::move(ranking_view));
  }
  return ranking;
}

int NearestView(const RankingModel& model, const Eigen::Isometry3f& T_sensor_object) {
  const Eigen::Vector3f to_sensor =
      T_sensor_object.linear().transpose() * -T_sensor_object.translation() - model.centre;
  int nearest = -1;
  float best = 0.0f;
  for (std::size_t v = 0; v < model.views.size(); ++v) {
    const float cosine = to_sensor.dot(model.views[v].direction);
    if (nearest >= 0 && cosine <= best) continue;
    best = cosine;
    nearest = static_cast<int>(v);
  }
  return nearest;
}

double RankingScore(const Scene& scene, const RankingModel& model,
                    const Eigen::Isometry3f& T_sensor_object, double epsilon,
                    const RankingParams& params) {
  const int nearest = NearestView(model, T_sensor_object);
  if (nearest < 0) return 0.0;
  const RankingView& view = model.views[nearest];
  const std::size_t count = view.surface.points.size();
  if (count == 0) return 0.0;
  const float eps = static_cast<float>(epsilon);
  Tally tally;
  const std::size_t first = std::min(count, static_cast<std::size_t>(params.first_points));
  for (std::size_t i = 0; i < first; ++i)
    Count(scene, T_sensor_object * view.surface.points[i], eps, &tally);
  if (tally.hits < params.first_min_share * static_cast<double>(first)) return 0.0;
  for (std::size_t i = first; i < count; ++i)
    Count(scene, T_sensor_object * view.surface.points[i], eps, &tally);
  int going_on = 0;
  for (const Eigen::Vector3f& point : view.outside)
    going_on += GoesOn(scene, T_sensor_object * point, eps);

  const double n = static_cast<double>(count);
  const double inside = (tally.at_place - params.see_through * tally.looked_through) / n;
  const double outside =
      view.outside.empty() ? 0.0 : going_on / static_cast<double>(view.outside.size());
  return inside - params.outside * outside;
}

}  // namespace rimod
