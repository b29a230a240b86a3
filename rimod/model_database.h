#pragma once

#include <memory>
#include <vector>

#include "rimod/descriptor_index.h"
#include "rimod/descriptor_projection.h"
#include "rimod/execution.h"
#include "rimod/false_positive_rejection.h"
#include "rimod/hypothesis_ranking.h"
#include "rimod/judged_model.h"
#include "rimod/object_model.h"
#include "rimod/params.h"

namespace rimod {

// The models that are looked for, with everything that searching needs. Immutable; the order of the
// given models does not matter. Models whose features come from other parameters get their views
// computed anew. Throws std::invalid_argument for an invalid model, two of one name or a
// descriptor that the method cannot use.
class ModelDatabase {
 public:
  ModelDatabase(std::vector<ObjectModel> models, const PipelineParams& params,
                const Execution& execution);
  // Parts refer to each other.
  ModelDatabase(const ModelDatabase&) = delete;
  ModelDatabase& operator=(const ModelDatabase&) = delete;

  // Sorted by name. Prepared for the default method they have lost their views' lists, which make
  // most of a model's bytes: what it needs of them stands below, in its own form.
  const std::vector<ObjectModel>& models() const { return models_; }
  // The method that it was prepared for.
  Method method() const { return method_; }
  // Of the models' features; empty when there are no models.
  const std::string& descriptor_kind() const { return descriptor_kind_; }

  // Where a feature of the index is on its model; object frame.
  struct PlacedFeature : OrientedPoint {
    int model = 0;
    int view = 0;  // that it was seen in
  };
  // All models' features in one list, which the indices number: model after model, view after view.
  const PlacedFeature& feature(int index) const { return placed_features_[index]; }
  // The number of a model's first feature in that list; for model = models().size() that of all.
  int first_feature(int model) const { return first_features_[model]; }

  // For the paper's method; absent or empty otherwise. features: of a model, in the list's order.
  const DescriptorIndex& descriptors() const { return *descriptors_; }
  const std::vector<const Feature*>& features(int model) const { return features_[model]; }
  const std::vector<CollisionShape>& collision_shapes() const { return collision_shapes_; }

  // For the default method: each model's descriptors shortened for faster search, numbered from the
  // model's first feature on, and the models as its stages want them. What is kept of a model does
  // not depend on the others.
  const DescriptorProjection& projection() const { return *projection_; }
  const DescriptorIndex& projected_descriptors(int model) const {
    return projected_descriptors_[model];
  }
  const std::vector<RankingModel>& ranking_models() const { return ranking_models_; }
  const std::vector<JudgedModel>& judged_models() const { return judged_models_; }

 private:
  void PrepareModels(const PipelineParams& params, const Execution& execution);
  void PlaceFeatures();
  void PreparePaperMethod(const PipelineParams& params, const Execution& execution);
  void PrepareDefaultMethod(const PipelineParams& params, const Execution& execution);

  Method method_;
  std::vector<ObjectModel> models_;
  std::string descriptor_kind_;
  std::vector<PlacedFeature> placed_features_;
  std::vector<int> first_features_;
  std::vector<std::vector<const Feature*>> features_;  // point into models_
  std::unique_ptr<DescriptorIndex> descriptors_;
  std::vector<CollisionShape> collision_shapes_;
  std::unique_ptr<DescriptorProjection> projection_;
  std::vector<DescriptorIndex> projected_descriptors_;  // of each model
  std::vector<RankingModel> ranking_models_;
  std::vector<JudgedModel> judged_models_;  // refer to models_
};

}  // namespace rimod
