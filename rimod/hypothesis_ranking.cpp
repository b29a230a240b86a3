#include "rimod/hypothesis_ranking.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "rimod/check.h"

namespace rimod {
namespace {

// What one of the surface's points says: the pixel where it falls, its distance from the sensor and
// its normal (sensor frame) as far as it is needed.
template <typename Normal>
void Count(const Scene& scene, int pixel, float range, const Normal& normal, float epsilon,
           RankingFigures* figures) {
  if (pixel < 0) return;
  const float measured = scene.range(pixel);
  if (measured == 0.0f) return;
  const float behind = measured - range;
  if (behind < -epsilon) return;  // occluded
  figures->known += 1.0f;
  if (behind > epsilon) {
    figures->looked_through += 1.0f;
    return;
  }
  figures->at_place += 1.0f - std::abs(behind) / epsilon;
  figures->hits += 1.0f;
  figures->agreeing += scene.normal(pixel).dot(normal());
}

void CountOutside(const Scene& scene, int pixel, float range, float epsilon,
                  RankingFigures* figures) {
  if (pixel < 0) return;
  const float measured = scene.range(pixel);
  if (measured == 0.0f) return;
  const float behind = measured - range;
  if (behind > epsilon) figures->jumps += 1.0f;
  if (std::abs(behind) <= epsilon) figures->goes_on += 1.0f;
}

void Normalise(float count, float outside_count, RankingFigures* figures) {
  for (float* figure : {&figures->at_place, &figures->hits, &figures->looked_through,
                        &figures->known, &figures->agreeing})
    *figure /= count;
  if (outside_count <= 0.0f) return;
  figures->goes_on /= outside_count;
  figures->jumps /= outside_count;
}

void CheckQuota(const std::string& name, const ModelQuota& quota, int largest) {
  CheckWithin("ranking " + name + "_most", quota.most, 1, largest);
  CheckWithin("ranking " + name + "_always", quota.always, 0, quota.most);
  CheckWithin("ranking " + name + "_min_score", quota.min_score, 0.0, 1.0);
}

}  // namespace

void RankingParams::Validate() const {
  CheckWithin("ranking min_normal_cosine", min_normal_cosine, -1.0, 1.0);
  CheckWithin("ranking min_tilt", min_tilt, 0.0, 3.2);
  CheckWithin("ranking max_tilt", max_tilt, 0.0, 3.2);
  CheckWithin("ranking coarse_epsilon", coarse_epsilon, 1e-3, 10.0);
  CheckWithin("ranking fine_epsilon", fine_epsilon, 1e-3, 10.0);
  CheckWithin("ranking first_points", first_points, 1, 10000);
  CheckWithin("ranking first_min_share", first_min_share, 0.0, 1.0);
  CheckWithin("ranking second_points", second_points, 1, 10000);
  CheckWithin("ranking second_min_share", second_min_share, 0.0, 1.0);
  CheckWithin("ranking min_known", min_known, 0.0, 1.0);
  CheckWithin("ranking num_models", num_models, 0, 1'000'000);
  CheckWithin("ranking full_models", full_models, 1, 1'000'000);
  CheckWithin("ranking max_scanned", max_scanned, 1, 100'000'000);
  CheckQuota("refined", refined, 1'000'000);
  CheckQuota("judged", judged, 100'000);
  CheckWithin("ranking min_screened_score", min_screened_score, 0.0, 1.0);
  CheckWithin("ranking same_distance", same_distance, 1e-4, 10.0);
  CheckWithin("ranking same_angle", same_angle, 1e-4, 3.2);
}

RankingModel MakeRankingModel(const ObjectModel& model) {
  RankingModel ranking;
  const Eigen::Vector3d centre = 0.5 * (model.box_min + model.box_max);
  ranking.centre = centre.cast<float>();
  for (const ModelView& view : model.views) {
    RankingView ranking_view;
    ranking_view.direction = (view.viewpoint - centre).normalized().cast<float>();
    ranking_view.surface = {view.validation_points, view.validation_normals};
    ranking_view.points = PointColumns(view.validation_points);
    ranking_view.outside = PointColumns(view.outside_points);
    ranking.views.push_back(std::move(ranking_view));
  }
  return ranking;
}

double PixelsAcross(const Scene& scene, const ObjectModel& model,
                    const Eigen::Isometry3d& T_sensor_object) {
  constexpr double kNearest = 1e-3;  // m
  const double distance = std::max(T_sensor_object.translation().norm(), kNearest);
  return model.Diameter() / distance / scene.grid().resolution;
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

bool CompareViewPoints(const Scene& scene, const RankingModel& model,
                       const Eigen::Isometry3f& T_sensor_object, double epsilon,
                       const RankingParams& params, RankingFigures* figures) {
  const int nearest = NearestView(model, T_sensor_object);
  if (nearest < 0) return false;
  const RankingView& view = model.views[nearest];
  const std::size_t count = view.surface.points.size();
  if (count == 0) return false;
  const float eps = static_cast<float>(epsilon);
  for (float* figure : {&figures->at_place, &figures->hits, &figures->looked_through,
                        &figures->known, &figures->agreeing, &figures->goes_on, &figures->jumps})
    *figure = 0.0f;
  ProjectedPoints projected;
  const auto compare = [&](std::size_t begin, std::size_t end) {
    scene.Project(view.points, T_sensor_object, begin, end, &projected);
    for (std::size_t i = begin; i < end; ++i) {
      const auto normal = [&]() -> Eigen::Vector3f {
        return T_sensor_object.linear() * view.surface.normals[i];
      };
      Count(scene, projected.pixels[i], projected.ranges[i], normal, eps, figures);
    }
  };
  const std::size_t first = std::min(count, static_cast<std::size_t>(params.first_points));
  const auto hopeless = [&](std::size_t compared, double min_share) {
    return figures->known < params.min_known * static_cast<double>(compared) ||
           figures->hits < min_share * figures->known;
  };
  compare(0, first);
  if (hopeless(first, params.first_min_share)) return false;
  const std::size_t second =
      std::clamp(static_cast<std::size_t>(params.second_points), first, count);
  compare(first, second);
  if (hopeless(second, params.second_min_share)) return false;
  compare(second, count);
  scene.Project(view.outside, T_sensor_object, 0, view.outside.size(), &projected);
  for (std::size_t i = 0; i < view.outside.size(); ++i)
    CountOutside(scene, projected.pixels[i], projected.ranges[i], eps, figures);
  Normalise(static_cast<float>(count), static_cast<float>(view.outside.size()), figures);
  return true;
}

}  // namespace rimod
