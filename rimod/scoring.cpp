#include "rimod/scoring.h"

#include <algorithm>
#include <cmath>

#include "rimod/check.h"

namespace rimod {

void ScoringParams::Validate() const {
  CheckWithin("scoring epsilon", epsilon, 1e-3, 10.0);
  CheckWithin("scoring penalty", penalty, 0.0, 1e6);
  CheckWithin("scoring no_return_penalty", no_return_penalty, 0.0, 1e6);
  CheckWithin("scoring window", window, 0, 3);
  CheckWithin("scoring gamma", gamma, 0.0, 1.0);
}

double PointScore(double d_v, double d_s, const ScoringParams& params) {
  if (d_s - d_v > params.epsilon) return -params.penalty;  // the laser went through
  if (d_v - d_s > params.epsilon) return 0.0;              // occluded
  return 1.0 - std::abs(d_v - d_s) / params.epsilon;
}

double PointScoreInImage(const RangeImage& image, const Eigen::Vector3d& p_sensor,
                         const ScoringParams& params) {
  const PixelPosition position = Project(image.grid(), p_sensor);
  const int own_row = static_cast<int>(std::floor(position.row));
  const int own_column = static_cast<int>(std::floor(position.column));
  const double d_v = p_sensor.norm();
  bool observed = false;
  double best = 0.0;
  for (int row = own_row - params.window; row <= own_row + params.window; ++row) {
    for (int column = own_column - params.window; column <= own_column + params.window; ++column) {
      if (!image.grid().Contains(row, column)) continue;
      const Pixel kind = image.pixel(row, column);
      if (kind == Pixel::kNeverObserved) continue;
      const double score = kind == Pixel::kMeasured
                               ? PointScore(d_v, image.range(row, column), params)
                               : -params.no_return_penalty;
      best = observed ? std::max(best, score) : score;
      observed = true;
    }
  }
  return observed ? best : 0.0;
}

int NearestView(const ObjectModel& model, const Eigen::Isometry3d& T_sensor_object) {
  const Eigen::Vector3d centre = 0.5 * (model.box_min + model.box_max);
  const Eigen::Vector3d to_sensor = (T_sensor_object.inverse().translation() - centre).normalized();
  int nearest = -1;
  double best_cosine = -2.0;
  for (std::size_t v = 0; v < model.views.size(); ++v) {
    const double cosine = to_sensor.dot((model.views[v].viewpoint - centre).normalized());
    if (cosine > best_cosine) {
      best_cosine = cosine;
      nearest = static_cast<int>(v);
    }
  }
  return nearest;
}

double ScorePose(const RangeImage& image, const ObjectModel& model,
                 const Eigen::Isometry3d& T_sensor_object, const ScoringParams& params) {
  const int view = NearestView(model, T_sensor_object);
  if (view < 0 || model.views[view].validation_points.empty()) return 0.0;
  const double n = static_cast<double>(model.views[view].validation_points.size());
  double sum = 0.0, most = n;  // most: the sum if all points to come fit perfectly
  for (const Eigen::Vector3f& p_object : model.views[view].validation_points) {
    const double score =
        PointScoreInImage(image, T_sensor_object * p_object.cast<double>(), params);
    sum += score;
    most += score - 1.0;
    if (most < params.gamma * n) return 0.0;
  }
  return std::max(0.0, sum) / n;  // eq. 2
}

}  // namespace rimod
