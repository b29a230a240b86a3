#include "rimod/feature_support.h"

#include <algorithm>

namespace rimod {
namespace {

constexpr float kSamePlace = 0.06f;  // m
constexpr float kSameNormal = 0.8f;  // cosine

}  // namespace

FeatureSupportCounter::FeatureSupportCounter(const FeatureSet& features,
                                             const ModelMatches& matches,
                                             const ModelDatabase& database)
    : features_(features), matches_(matches), database_(database) {}

FeatureSupport FeatureSupportCounter::Count(const Candidate& candidate) const {
  const ObjectModel& model = database_.models()[candidate.model];
  const Eigen::Isometry3f T_object_sensor = candidate.T_sensor_object.inverse().cast<float>();
  const Eigen::Array3f low = model.box_min.cast<float>().array() - 0.5f * kSamePlace;
  const Eigen::Array3f high = model.box_max.cast<float>().array() + 0.5f * kSamePlace;
  FeatureSupport support;
  Feature on_object;  // object frame
  for (std::size_t i = 0; i < features_.features.size(); ++i) {
    on_object.position = T_object_sensor * features_.features[i].position;
    if ((on_object.position.array() < low).any() || (on_object.position.array() > high).any())
      continue;
    ++support.inside;
    on_object.normal = T_object_sensor.linear() * features_.features[i].normal;
    support.matching += HasMatch(candidate.model, static_cast<int>(i), on_object);
  }
  return support;
}

bool FeatureSupportCounter::HasMatch(int model, int scene_feature, const Feature& on_object) const {
  const std::vector<Correspondence>& matches = matches_[model];
  const auto first = std::partition_point(
      matches.begin(), matches.end(),
      [&](const Correspondence& match) { return match.scene_feature < scene_feature; });
  for (auto match = first; match != matches.end() && match->scene_feature == scene_feature;
       ++match) {
    const ModelDatabase::PlacedFeature& feature = database_.feature(match->model_feature);
    if ((feature.position - on_object.position).squaredNorm() < kSamePlace * kSamePlace &&
        feature.normal.dot(on_object.normal) > kSameNormal)
      return true;
  }
  return false;
}

}  // namespace rimod
