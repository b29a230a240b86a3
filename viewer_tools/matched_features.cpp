#include "viewer_tools/matched_features.h"

#include "rimod/descriptor_index.h"

namespace rimod {
namespace {

// What a pixel's width, the pose's error and the views' spacing may make of one place.
constexpr double kMaxDistance = 0.08;            // m
constexpr double kMaxDescriptorDistance = 0.05;  // m
constexpr float kMinNormalCosine = 0.866f;       // 30 degrees

bool IsExplained(const Feature& on_object, const ObjectModel& model) {
  const int min_shared = model.descriptor_size / 4;
  for (const ModelView& view : model.views) {
    for (const Feature& feature : view.features) {
      if ((feature.position - on_object.position).norm() <= kMaxDistance &&
          feature.normal.dot(on_object.normal) >= kMinNormalCosine &&
          DescriptorDistance(feature.descriptor, on_object.descriptor, min_shared) <=
              kMaxDescriptorDistance)
        return true;
    }
  }
  return false;
}

}  // namespace

std::vector<int> MatchedFeatures(const FeatureSet& features, const ObjectModel& model,
                                 const Eigen::Isometry3d& T_sensor_object) {
  std::vector<int> matched;
  if (features.descriptor_size != model.descriptor_size) return matched;
  const Eigen::Isometry3f T_object_sensor = T_sensor_object.inverse().cast<float>();
  const Eigen::AlignedBox3d box(model.box_min.array() - kMaxDistance,
                                model.box_max.array() + kMaxDistance);
  for (std::size_t i = 0; i < features.features.size(); ++i) {
    Feature on_object = features.features[i];
    on_object.position = T_object_sensor * on_object.position;
    on_object.normal = T_object_sensor.linear() * on_object.normal;
    if (box.contains(on_object.position.cast<double>()) && IsExplained(on_object, model))
      matched.push_back(static_cast<int>(i));
  }
  return matched;
}

}  // namespace rimod
