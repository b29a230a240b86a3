#include "rimod/false_positive_rejection.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "rimod/check.h"
#include "rimod/surface_rendering.h"

namespace rimod {
namespace {

Eigen::Vector3d CentreOf(const ObjectModel& model, const Eigen::Isometry3d& T_sensor_object) {
  return T_sensor_object * Eigen::Vector3d(0.5 * (model.box_min + model.box_max));
}

// Means of the points in each cell of a grid, in the order of the cells.
std::vector<Eigen::Vector3d> LowResolution(const ObjectModel& model, double cell) {
  std::map<std::tuple<long, long, long>, std::pair<Eigen::Vector3d, int>> cells;
  for (const Eigen::Vector3f& point : model.points) {
    const Eigen::Vector3d p = point.cast<double>();
    auto& [sum, count] = cells
                             .try_emplace({std::lround(p.x() / cell), std::lround(p.y() / cell),
                                           std::lround(p.z() / cell)},
                                          Eigen::Vector3d::Zero(), 0)
                             .first->second;
    sum += p;
    ++count;
  }
  std::vector<Eigen::Vector3d> points;
  points.reserve(cells.size());
  for (const auto& [key, mean] : cells) points.push_back(mean.first / mean.second);
  return points;
}

// For a pixel exactly gap pixels outside the silhouette the range of the model's pixel next to it,
// else 0.
float RangeAtGap(const RenderedModel& rendered, int row, int column, int gap) {
  float range = 0.0f;
  for (int r = std::max(row - gap, 0); r <= std::min(row + gap, rendered.height - 1); ++r) {
    for (int c = std::max(column - gap, 0); c <= std::min(column + gap, rendered.width - 1); ++c) {
      if (rendered.point(r, c) < 0) continue;
      if (std::max(std::abs(r - row), std::abs(c - column)) < gap) return 0.0f;
      range = std::max(range, rendered.range(r, c));
    }
  }
  return range;
}

}  // namespace

bool BetterCandidate(const Candidate& a, const Candidate& b) {
  if (a.score != b.score) return a.score > b.score;
  if (a.model != b.model) return a.model < b.model;
  const auto key = [](const Candidate& c) {
    const Eigen::Vector3d t = c.T_sensor_object.translation();
    const Eigen::Matrix3d R = c.T_sensor_object.linear();
    return std::make_tuple(t.x(), t.y(), t.z(), R(0, 0), R(1, 0), R(2, 1));
  };
  return key(a) < key(b);
}

void PruningParams::Validate() const { CheckWithin("pruning radius", radius, 0.0, 10.0); }

std::vector<Candidate> PruneToLocalBest(std::vector<Candidate> candidates,
                                        const std::vector<ObjectModel>& models,
                                        const PruningParams& params) {
  params.Validate();
  std::sort(candidates.begin(), candidates.end(), BetterCandidate);
  std::vector<Candidate> kept;
  std::vector<std::vector<Eigen::Vector3d>> kept_centres(models.size());
  for (const Candidate& candidate : candidates) {
    const ObjectModel& model = models[candidate.model];
    const Eigen::Vector3d centre = CentreOf(model, candidate.T_sensor_object);
    const double radius = params.radius * model.Diameter();
    std::vector<Eigen::Vector3d>& taken = kept_centres[candidate.model];
    const bool near_better = std::any_of(taken.begin(), taken.end(), [&](const Eigen::Vector3d& c) {
      return (c - centre).norm() < radius;
    });
    if (near_better) continue;
    taken.push_back(centre);
    kept.push_back(candidate);
  }
  return kept;
}

void CollisionParams::Validate() const {
  CheckWithin("collisions cell", cell, 0.005, 1.0);
  CheckWithin("collisions max_share", max_share, 0.0, 1.0);
}

CollisionShape::CollisionShape(const ObjectModel& model, double cell)
    : tree_(LowResolution(model, cell)), centre_(0.5 * (model.box_min + model.box_max)) {
  for (const Eigen::Vector3d& point : tree_.points())
    radius_ = std::max(radius_, (point - centre_).norm());
}

bool CollisionShape::HasPointWithin(const Eigen::Vector3d& p_object, double distance) const {
  return tree_.DistanceToNearest(p_object, 1) < distance;
}

std::vector<Candidate> RejectCollisions(const std::vector<Candidate>& candidates,
                                        const std::vector<CollisionShape>& shapes,
                                        const CollisionParams& params) {
  params.Validate();
  std::vector<Candidate> kept;
  const auto collides = [&](const Candidate& a, const Candidate& b) {
    const CollisionShape* small = &shapes[a.model];
    const CollisionShape* large = &shapes[b.model];
    Eigen::Isometry3d T_large_small = b.T_sensor_object.inverse() * a.T_sensor_object;
    if (small->points().size() > large->points().size()) {
      std::swap(small, large);
      T_large_small = T_large_small.inverse();
    }
    const double apart = (T_large_small * small->centre() - large->centre()).norm();
    if (apart > small->radius() + large->radius()) return false;
    const auto hits = std::count_if(small->points().begin(), small->points().end(),
                                    [&](const Eigen::Vector3d& p) {
                                      return large->HasPointWithin(T_large_small * p, params.cell);
                                    });
    return static_cast<double>(hits) >
           params.max_share * static_cast<double>(small->points().size());
  };
  for (const Candidate& candidate : candidates) {
    const bool hit = std::any_of(kept.begin(), kept.end(), [&](const Candidate& better) {
      return collides(candidate, better);
    });
    if (!hit) kept.push_back(candidate);
  }
  return kept;
}

void ValidationParams::Validate() const {
  scoring.Validate();
  CheckWithin("validation min_score", min_score, 0.0, 1.0);
  CheckWithin("validation min_pixels", min_pixels, 1, 1'000'000);
  CheckWithin("validation half_trust_pixels", half_trust_pixels, 0, 1'000'000);
  CheckWithin("validation outside_weight", outside_weight, 0.0, 10.0);
  CheckWithin("validation outside_gap", outside_gap, 1, 10);
  CheckWithin("validation outside_depth", outside_depth, 1e-3, 10.0);
  CheckWithin("validation ground_height", ground_height, 0.0, 10.0);
}

SilhouetteSurroundings LookAround(const RangeImage& image, const RenderedModel& rendered,
                                  const Eigen::Isometry3d& T_sensor_object,
                                  const ValidationParams& params) {
  const int gap = params.outside_gap;
  const Eigen::Isometry3d T_object_sensor = T_sensor_object.inverse();
  SilhouetteSurroundings around;
  for (int row = -gap; row < rendered.height + gap; ++row) {
    for (int column = -gap; column < rendered.width + gap; ++column) {
      const float range = RangeAtGap(rendered, row, column, gap);
      if (range <= 0.0f) continue;
      const int image_row = rendered.first_row + row, image_column = rendered.first_column + column;
      if (!image.grid().Contains(image_row, image_column)) continue;
      const Pixel kind = image.pixel(image_row, image_column);
      if (kind == Pixel::kNeverObserved) continue;
      const double behind = image.range(image_row, image_column) - range;
      const bool jump = kind == Pixel::kNoReturn || behind > params.outside_depth;
      if (!jump && behind < -params.outside_depth) continue;  // hidden by something nearer
      if (!jump) {
        const Eigen::Vector3d p_sensor = image.point(image_row, image_column).cast<double>();
        if ((T_object_sensor * p_sensor).z() < params.ground_height) continue;
        ++around.continued;
      }
      ++around.compared;
    }
  }
  return around;
}

double ValidatePose(const RangeImage& image, const ObjectModel& model,
                    const Eigen::Isometry3d& T_sensor_object, const ValidationParams& params) {
  const RenderedModel rendered = RenderModel(model, T_sensor_object, image.grid());
  double sum = 0.0;
  int count = 0;
  for (int row = 0; row < rendered.height; ++row) {
    for (int column = 0; column < rendered.width; ++column) {
      if (rendered.point(row, column) < 0) continue;
      const Eigen::Vector3d p_sensor =
          rendered.range(row, column) * PixelBeam(image.grid(), rendered.first_row + row + 0.5,
                                                  rendered.first_column + column + 0.5);
      sum += PointScoreInImage(image, p_sensor, params.scoring);
      ++count;
    }
  }
  if (count < params.min_pixels) return 0.0;
  double score = sum / count;
  if (params.outside_weight > 0.0) {
    const SilhouetteSurroundings around = LookAround(image, rendered, T_sensor_object, params);
    if (around.compared > 0) score -= params.outside_weight * around.continued / around.compared;
  }
  return std::max(0.0, score) * count / (count + params.half_trust_pixels);
}

}  // namespace rimod
