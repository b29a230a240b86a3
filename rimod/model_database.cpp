#include "rimod/model_database.h"

#include <algorithm>
#include <stdexcept>

#include "rimod/feature_extraction.h"

namespace rimod {

ModelDatabase::ModelDatabase(std::vector<ObjectModel> models, const PipelineParams& params,
                             const Execution& execution)
    : models_(std::move(models)) {
  std::sort(models_.begin(), models_.end(),
            [](const ObjectModel& a, const ObjectModel& b) { return a.name < b.name; });
  for (std::size_t m = 0; m < models_.size(); ++m) {
    ValidateModel(models_[m]);
    if (m > 0 && models_[m].name == models_[m - 1].name)
      throw std::invalid_argument("two models of the name " + models_[m].name);
    if (!ModelMatchesParams(models_[m], params)) ComputeModelViews(params, execution, &models_[m]);
  }
  if (!models_.empty()) descriptor_kind_ = models_.front().descriptor_kind;

  features_.resize(models_.size());
  std::vector<const Descriptor*> descriptors;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    for (const ModelView& view : models_[m].views) {
      for (const Feature& feature : view.features) {
        origins_.push_back({static_cast<int>(m), static_cast<int>(features_[m].size())});
        features_[m].push_back(&feature);
        descriptors.push_back(&feature.descriptor);
      }
    }
    collision_shapes_.emplace_back(models_[m], params.collisions.cell);
  }
  descriptors_ = std::make_unique<DescriptorIndex>(descriptors);
}

}  // namespace rimod
