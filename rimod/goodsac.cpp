#include "rimod/goodsac.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "rimod/absolute_orientation.h"
#include "rimod/check.h"

namespace rimod {
namespace {

// The points of a correspondence.
struct Pair {
  Eigen::Vector3d scene, model;
  Eigen::Vector3d scene_normal, model_normal;
};

// Early rejection of two correspondences: too near to each other, or their distance in the scene
// differs from that in the model.
bool Compatible(const Pair& a, const Pair& b, const GoodsacParams& params) {
  const double in_scene = (a.scene - b.scene).norm();
  const double in_model = (a.model - b.model).norm();
  return std::min(in_scene, in_model) >= params.min_separation &&
         std::abs(in_scene - in_model) <= params.distance_tolerance;
}

bool Collinear(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
               double min_height) {
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return (b - a).cross(c - a).norm() < min_height * longest;
}

std::optional<Eigen::Isometry3d> PoseOf(const std::array<const Pair*, 3>& triple,
                                        const GoodsacParams& params) {
  if (Collinear(triple[0]->scene, triple[1]->scene, triple[2]->scene, params.min_triangle_height))
    return std::nullopt;
  const Eigen::Isometry3d T_sensor_object =
      AbsoluteOrientation({triple[0]->model, triple[1]->model, triple[2]->model},
                          {triple[0]->scene, triple[1]->scene, triple[2]->scene});
  if (T_sensor_object.linear()(2, 2) < std::cos(params.max_tilt)) return std::nullopt;
  for (const Pair* pair : triple) {
    const Eigen::Vector3d turned = T_sensor_object.linear() * pair->model_normal;
    if (turned.dot(pair->scene_normal) < params.min_normal_cosine) return std::nullopt;
  }
  return T_sensor_object;
}

std::vector<Pair> BestPairs(std::vector<Correspondence> correspondences,
                            const std::vector<Feature>& scene_features,
                            const std::vector<const Feature*>& model_features, int max_count) {
  std::sort(correspondences.begin(), correspondences.end(),
            [](const Correspondence& a, const Correspondence& b) {
              if (a.distance != b.distance) return a.distance < b.distance;
              if (a.scene_feature != b.scene_feature) return a.scene_feature < b.scene_feature;
              return a.model_feature < b.model_feature;
            });
  if (static_cast<int>(correspondences.size()) > max_count) correspondences.resize(max_count);
  std::vector<Pair> pairs;
  for (const Correspondence& correspondence : correspondences) {
    const Feature& scene = scene_features[correspondence.scene_feature];
    const Feature& model = *model_features[correspondence.model_feature];
    pairs.push_back({scene.position.cast<double>(), model.position.cast<double>(),
                     scene.normal.cast<double>(), model.normal.cast<double>()});
  }
  return pairs;
}

}  // namespace

void GoodsacParams::Validate() const {
  constexpr double kPi = 3.14159265358979323846;
  CheckWithin("goodsac max_correspondences", max_correspondences, 3, 100'000);
  CheckWithin("goodsac max_trials", max_trials, 1, 100'000'000);
  CheckWithin("goodsac max_triples", max_triples, 1, 2'000'000'000);
  CheckWithin("goodsac min_separation", min_separation, 0.0, 10.0);
  CheckWithin("goodsac distance_tolerance", distance_tolerance, 1e-4, 10.0);
  CheckWithin("goodsac min_triangle_height", min_triangle_height, 0.0, 10.0);
  CheckWithin("goodsac min_normal_cosine", min_normal_cosine, -1.0, 1.0);
  CheckWithin("goodsac max_tilt", max_tilt, 0.0, kPi);
}

void VisitTriples(int count, const std::function<bool(int, int, int)>& visit) {
  for (int k = 2; k < count; ++k)
    for (int j = 1; j < k; ++j)
      for (int i = 0; i < j; ++i)
        if (!visit(i, j, k)) return;
}

std::vector<Eigen::Isometry3d> CandidatePoses(std::vector<Correspondence> correspondences,
                                              const std::vector<Feature>& scene_features,
                                              const std::vector<const Feature*>& model_features,
                                              const GoodsacParams& params) {
  params.Validate();
  const std::vector<Pair> pairs = BestPairs(std::move(correspondences), scene_features,
                                            model_features, params.max_correspondences);
  const int count = static_cast<int>(pairs.size());
  std::vector<char> compatible(static_cast<std::size_t>(count) * count, 0);
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < a; ++b) compatible[a * count + b] = Compatible(pairs[a], pairs[b], params);

  std::vector<Eigen::Isometry3d> poses;
  int triples = 0;
  VisitTriples(count, [&](int i, int j, int k) {
    if (compatible[j * count + i] && compatible[k * count + i] && compatible[k * count + j]) {
      const std::optional<Eigen::Isometry3d> pose =
          PoseOf({&pairs[i], &pairs[j], &pairs[k]}, params);
      if (pose) poses.push_back(*pose);
    }
    return ++triples < params.max_triples && static_cast<int>(poses.size()) < params.max_trials;
  });
  return poses;
}

}  // namespace rimod
