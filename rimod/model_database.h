#pragma once

#include <memory>
#include <vector>

#include "rimod/descriptor_index.h"
#include "rimod/execution.h"
#include "rimod/false_positive_rejection.h"
#include "rimod/object_model.h"
#include "rimod/params.h"

namespace rimod {

// The models that are looked for, with everything that searching needs. Immutable; the order of the
// given models does not matter. Models whose features come from other parameters get their views
// computed anew. Throws std::invalid_argument for an invalid model or two of one name.
class ModelDatabase {
 public:
  ModelDatabase(std::vector<ObjectModel> models, const PipelineParams& params,
                const Execution& execution);

  // Sorted by name.
  const std::vector<ObjectModel>& models() const { return models_; }
  // Of the models' features; empty when there are no models.
  const std::string& descriptor_kind() const { return descriptor_kind_; }

  // All models' features in one list, which the index numbers.
  struct FeatureOrigin {
    int model = 0;
    int feature = 0;  // among the model's own, view after view
  };
  const DescriptorIndex& descriptors() const { return *descriptors_; }
  const FeatureOrigin& origin(int index) const { return origins_[index]; }
  // A model's features, view after view.
  const std::vector<const Feature*>& features(int model) const { return features_[model]; }

  const std::vector<CollisionShape>& collision_shapes() const { return collision_shapes_; }

 private:
  std::vector<ObjectModel> models_;
  std::string descriptor_kind_;
  std::vector<FeatureOrigin> origins_;
  std::vector<std::vector<const Feature*>> features_;  // point into models_
  std::unique_ptr<DescriptorIndex> descriptors_;
  std::vector<CollisionShape> collision_shapes_;
};

}  // namespace rimod
