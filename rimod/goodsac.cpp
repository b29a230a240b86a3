#include "rimod/goodsac.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "rimod/absolute_orientation.h"
#include "rimod/check.h"

namespace rimod {
namespace {

// The points of a correspondence.
struct Pair {
  Eigen::Vector3d scene, model;
  Eigen::Vector3d scene_normal, model_normal;
};

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

// Whether the normals stand to each other and to the line that joins the points in the scene as
// they do in the model.
bool NormalsAgree(const Pair& a, const Pair& b, double tolerance) {
  const Eigen::Vector3d scene_line = (b.scene - a.scene).normalized();
  const Eigen::Vector3d model_line = (b.model - a.model).normalized();
  const auto differ = [tolerance](double in_scene, double in_model) {
    return std::abs(in_scene - in_model) > tolerance;
  };
  return !differ(AngleBetween(a.scene_normal, scene_line),
                 AngleBetween(a.model_normal, model_line)) &&
         !differ(AngleBetween(b.scene_normal, scene_line),
                 AngleBetween(b.model_normal, model_line)) &&
         !differ(AngleBetween(a.scene_normal, b.scene_normal),
                 AngleBetween(a.model_normal, b.model_normal));
}

// Early rejection of two correspondences: too near to each other, or they lie to each other in the
// scene otherwise than in the model.
bool Compatible(const Pair& a, const Pair& b, const GoodsacParams& params) {
  constexpr double kAnyAngle = 3.14;  // rad
  const Eigen::Vector3d scene_step = b.scene - a.scene, model_step = b.model - a.model;
  if (std::abs(scene_step.z() - model_step.z()) > params.height_tolerance) return false;
  const double in_scene = scene_step.norm(), in_model = model_step.norm();
  if (std::min(in_scene, in_model) < params.min_separation) return false;
  if (std::abs(in_scene - in_model) > params.distance_tolerance) return false;
  return params.angle_tolerance > kAnyAngle || NormalsAgree(a, b, params.angle_tolerance);
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
  // Negated so that a pose that is no number (features may come over the bus) is left out too.
  if (!(T_sensor_object.linear()(2, 2) >= std::cos(params.max_tilt))) return std::nullopt;
  for (const Pair* pair : triple) {
    const Eigen::Vector3d turned = T_sensor_object.linear() * pair->model_normal;
    if (turned.dot(pair->scene_normal) < params.min_normal_cosine) return std::nullopt;
  }
  return T_sensor_object;
}

bool BetterCorrespondence(const Correspondence& a, const Correspondence& b) {
  if (a.distance != b.distance) return a.distance < b.distance;
  if (a.scene_feature != b.scene_feature) return a.scene_feature < b.scene_feature;
  return a.model_feature < b.model_feature;
}

// The best n correspondences (C' of the paper).
std::vector<Pair> BestPairs(std::vector<Correspondence> correspondences,
                            const std::vector<Feature>& scene_features,
                            const std::vector<const Feature*>& model_features,
                            const GoodsacParams& params) {
  std::sort(correspondences.begin(), correspondences.end(), BetterCorrespondence);
  const double spacing_sq = params.min_model_spacing * params.min_model_spacing;
  std::vector<std::vector<Eigen::Vector3d>> places(scene_features.size());  // of those kept
  std::vector<Pair> pairs;
  for (const Correspondence& correspondence : correspondences) {
    if (static_cast<int>(pairs.size()) >= params.max_correspondences) break;
    const Feature& scene = scene_features[correspondence.scene_feature];
    const Feature& model = *model_features[correspondence.model_feature];
    const Eigen::Vector3d place = model.position.cast<double>();
    std::vector<Eigen::Vector3d>& taken = places[correspondence.scene_feature];
    if (std::any_of(taken.begin(), taken.end(), [&](const Eigen::Vector3d& other) {
          return (other - place).squaredNorm() < spacing_sq;
        }))
      continue;
    taken.push_back(place);
    pairs.push_back({scene.position.cast<double>(), place, scene.normal.cast<double>(),
                     model.normal.cast<double>()});
  }
  return pairs;
}

// A number from [0, size), 1 <= size <= 2^32, the same from every standard library.
std::size_t Below(std::size_t size, std::mt19937* random) {
  return static_cast<std::size_t>((static_cast<std::uint64_t>((*random)()) * size) >> 32);
}

}  // namespace

void GoodsacParams::Validate() const {
  constexpr double kPi = 3.14159265358979323846;
  CheckWithin("goodsac max_correspondences", max_correspondences, 3, 100'000);
  CheckWithin("goodsac min_model_spacing", min_model_spacing, 0.0, 10.0);
  CheckWithin("goodsac max_trials", max_trials, 1, 100'000'000);
  CheckWithin("goodsac max_triples", max_triples, 1, 2'000'000'000);
  CheckWithin("goodsac min_separation", min_separation, 0.0, 10.0);
  CheckWithin("goodsac distance_tolerance", distance_tolerance, 1e-4, 10.0);
  CheckWithin("goodsac min_triangle_height", min_triangle_height, 0.0, 10.0);
  CheckWithin("goodsac min_normal_cosine", min_normal_cosine, -1.0, 1.0);
  CheckWithin("goodsac max_tilt", max_tilt, 0.0, kPi);
  CheckWithin("goodsac angle_tolerance", angle_tolerance, 0.0, kPi);
  CheckWithin("goodsac height_tolerance", height_tolerance, 1e-4, 1000.0);
  CheckWithin("goodsac max_poses_a_correspondence", max_poses_a_correspondence, 0, 100'000'000);
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
  const std::vector<Pair> pairs =
      BestPairs(std::move(correspondences), scene_features, model_features, params);
  const int count = static_cast<int>(pairs.size());
  const int limit =
      params.max_poses_a_correspondence > 0 ? params.max_poses_a_correspondence : params.max_trials;
  std::vector<Eigen::Isometry3d> poses;
  std::vector<std::vector<int>> partners(pairs.size());  // compatible and better, best first
  std::vector<char> fits(pairs.size(), 0);
  int triples = 0;
  for (int k = 0; k < count; ++k) {
    std::fill(fits.begin(), fits.end(), 0);
    for (int j = 0; j < k; ++j) {
      if (!Compatible(pairs[j], pairs[k], params)) continue;
      partners[k].push_back(j);
      fits[j] = 1;
    }
    int found = 0;
    for (const int j : partners[k]) {
      for (const int i : partners[j]) {
        if (found >= limit) break;
        if (!fits[i]) continue;
        if (++triples > params.max_triples) return poses;
        const std::optional<Eigen::Isometry3d> pose =
            PoseOf({&pairs[i], &pairs[j], &pairs[k]}, params);
        if (!pose) continue;
        poses.push_back(*pose);
        ++found;
        if (static_cast<int>(poses.size()) >= params.max_trials) return poses;
      }
    }
  }
  return poses;
}

std::vector<Eigen::Isometry3d> RandomCandidatePoses(
    std::vector<Correspondence> correspondences, const std::vector<Feature>& scene_features,
    const std::vector<const Feature*>& model_features, const GoodsacParams& params,
    std::uint32_t seed) {
  params.Validate();
  const std::vector<Pair> pairs =
      BestPairs(std::move(correspondences), scene_features, model_features, params);
  const int count = static_cast<int>(pairs.size());
  // Any two that can be of a triple, then any third: each triple can come from three of these.
  std::vector<std::array<int, 2>> compatible;
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < j; ++i)
      if (Compatible(pairs[i], pairs[j], params)) compatible.push_back({i, j});
  std::vector<Eigen::Isometry3d> poses;
  if (compatible.empty()) return poses;
  std::mt19937 random(seed);
  for (int draw = 0; draw < params.max_triples; ++draw) {
    const auto& [i, j] = compatible[Below(compatible.size(), &random)];
    const int k = static_cast<int>(Below(pairs.size(), &random));
    if (k == i || k == j || !Compatible(pairs[i], pairs[k], params) ||
        !Compatible(pairs[j], pairs[k], params))
      continue;
    const std::optional<Eigen::Isometry3d> pose = PoseOf({&pairs[i], &pairs[j], &pairs[k]}, params);
    if (!pose) continue;
    poses.push_back(*pose);
    if (static_cast<int>(poses.size()) >= params.max_trials) break;
  }
  return poses;
}

}  // namespace rimod
