#include "rimod/hypothesis_ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "rimod/check.h"

namespace rimod {
namespace {

// Of pixels where nothing is known: as what is hidden, such points say nothing.
constexpr float kUnknown = -std::numeric_limits<float>::infinity();

// How many reach the threshold.
int CountFrom(const float* values, std::size_t count, float threshold) {
  int reach = 0;
  for (std::size_t i = 0; i < count; ++i) reach += values[i] >= threshold;
  return reach;
}

int CountAbove(const float* values, std::size_t count, float threshold) {
  int above = 0;
  for (std::size_t i = 0; i < count; ++i) above += values[i] > threshold;
  return above;
}

// Sum of 1 - |difference| / epsilon of those within epsilon; in four sums, which processors add at
// once.
float Closeness(const float* differences, std::size_t count, float epsilon) {
  constexpr std::size_t kLanes = 4;
  float sums[kLanes] = {};
  const auto add = [&](std::size_t i, std::size_t lane) {
    sums[lane] += std::max(0.0f, 1.0f - std::abs(differences[i]) / epsilon);
  };
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) add(i + lane, lane);
  for (; i < count; ++i) add(i, 0);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
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
  CheckWithin("ranking min_coarse_pixels", min_coarse_pixels, 0.0, 1e6);
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
  const Eigen::Vector3d p_sensor = T_sensor_object.translation();
  const double distance = std::max(p_sensor.norm(), kNearest);
  return model.Diameter() / distance / PixelAngle(scene.grid(), p_sensor);
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

ViewComparison::ViewComparison(const Scene& scene, double epsilon, const RankingParams& params)
    : scene_(scene), epsilon_(static_cast<float>(epsilon)), params_(params) {}

// Fills behind_ for the points [begin, end).
void ViewComparison::Look(const PointColumns& points, const Eigen::Isometry3f& T_sensor_object,
                          std::size_t begin, std::size_t end) {
  scene_.Project(points, T_sensor_object, begin, end, &projected_);
  behind_.resize(std::max(behind_.size(), end));
  for (std::size_t i = begin; i < end; ++i) {
    const int pixel = projected_.pixels[i];
    const float measured = pixel < 0 ? 0.0f : scene_.range(pixel);
    behind_[i] = measured == 0.0f ? kUnknown : measured - projected_.ranges[i];
  }
}

void ViewComparison::ComparePoints(const RankingView& view,
                                   const Eigen::Isometry3f& T_sensor_object, std::size_t begin,
                                   std::size_t end, RankingFigures* figures) {
  Look(view.points, T_sensor_object, begin, end);
  const float* const behind = behind_.data() + begin;
  const std::size_t count = end - begin;
  const int known = CountFrom(behind, count, -epsilon_);
  const int looked_through = CountAbove(behind, count, epsilon_);
  figures->known += static_cast<float>(known);
  figures->looked_through += static_cast<float>(looked_through);
  figures->hits += static_cast<float>(known - looked_through);
  figures->at_place += Closeness(behind, count, epsilon_);
  float agreeing = 0.0f;
  for (std::size_t i = begin; i < end; ++i) {
    if (!(std::abs(behind_[i]) <= epsilon_)) continue;
    const Eigen::Vector3f normal = T_sensor_object.linear() * view.surface.normals[i];
    agreeing += scene_.normal(projected_.pixels[i]).dot(normal);
  }
  figures->agreeing += agreeing;
}

void ViewComparison::CompareOutside(const RankingView& view,
                                    const Eigen::Isometry3f& T_sensor_object,
                                    RankingFigures* figures) {
  const std::size_t count = view.outside.size();
  Look(view.outside, T_sensor_object, 0, count);
  const int jumps = CountAbove(behind_.data(), count, epsilon_);
  figures->jumps = static_cast<float>(jumps);
  figures->goes_on = static_cast<float>(CountFrom(behind_.data(), count, -epsilon_) - jumps);
}

bool ViewComparison::Compare(const RankingModel& model, const Eigen::Isometry3f& T_sensor_object,
                             RankingFigures* figures) {
  const int nearest = NearestView(model, T_sensor_object);
  if (nearest < 0) return false;
  const RankingView& view = model.views[nearest];
  const std::size_t count = view.surface.points.size();
  if (count == 0) return false;
  for (float* figure : {&figures->at_place, &figures->hits, &figures->looked_through,
                        &figures->known, &figures->agreeing, &figures->goes_on, &figures->jumps})
    *figure = 0.0f;
  const std::size_t first = std::min(count, static_cast<std::size_t>(params_.first_points));
  const auto hopeless = [&](std::size_t compared, double min_share) {
    return figures->known < params_.min_known * static_cast<double>(compared) ||
           figures->hits < min_share * figures->known;
  };
  ComparePoints(view, T_sensor_object, 0, first, figures);
  if (hopeless(first, params_.first_min_share)) return false;
  const std::size_t second =
      std::clamp(static_cast<std::size_t>(params_.second_points), first, count);
  ComparePoints(view, T_sensor_object, first, second, figures);
  if (hopeless(second, params_.second_min_share)) return false;
  ComparePoints(view, T_sensor_object, second, count, figures);
  CompareOutside(view, T_sensor_object, figures);
  Normalise(static_cast<float>(count), static_cast<float>(view.outside.size()), figures);
  return true;
}

}  // namespace rimod
