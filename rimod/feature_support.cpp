#include "rimod/feature_support.h"

#include <algorithm>

namespace rimod {
namespace {

constexpr float kSamePlace = 0.06f;  // m
constexpr float kSameNormal = 0.8f;  // cosine

}  // namespace

FeatureSupportCounter::FeatureSupportCounter(const FeatureSet& features,
                                             const std::vector<Correspondence>& matches,
                                             const ModelDatabase& database)
    : features_(features),
      matches_(matches),
      database_(database),
      first_(features.features.size() + 1, matches.size()) {
  for (std::size_t i = matches.size(); i-- > 0;) first_[matches[i].scene_feature] = i;
  for (std::size_t i = features.features.size(); i-- > 0;)
    first_[i] = std::min(first_[i], first_[i + 1]);
}

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
    support.matching += std::any_of(
        matches_.begin() + static_cast<std::ptrdiff_t>(first_[i]),
        matches_.begin() + static_cast<std::ptrdiff_t>(first_[i + 1]),
        [&](const Correspondence& match) { return Explains(match, candidate.model, on_object); });
  }
  return support;
}

bool FeatureSupportCounter::Explains(const Correspondence& match, int model,
                                     const Feature& on_object) const {
  const ModelDatabase::PlacedFeature& model_feature = database_.feature(match.model_feature);
  if (model_feature.model != model) return false;
  return (model_feature.position - on_object.position).squaredNorm() < kSamePlace * kSamePlace &&
         model_feature.normal.dot(on_object.normal) > kSameNormal;
}

}  // namespace rimod
