#include "rimod/model_database.h"

#include <algorithm>
#include <stdexcept>

#include "rimod/feature_extraction.h"

namespace rimod {
namespace {

std::vector<const Descriptor*> Descriptors(
    const std::vector<std::vector<const Feature*>>& features) {
  std::vector<const Descriptor*> descriptors;
  for (const std::vector<const Feature*>& list : features)
    for (const Feature* feature : list) descriptors.push_back(&feature->descriptor);
  return descriptors;
}

}  // namespace

ModelDatabase::ModelDatabase(std::vector<ObjectModel> models, const PipelineParams& params,
                             const Execution& execution)
    : method_(params.method), models_(std::move(models)) {
  std::sort(models_.begin(), models_.end(),
            [](const ObjectModel& a, const ObjectModel& b) { return a.name < b.name; });
  for (std::size_t m = 0; m < models_.size(); ++m) {
    ValidateModel(models_[m]);
    if (m > 0 && models_[m].name == models_[m - 1].name)
      throw std::invalid_argument("two models of the name " + models_[m].name);
    if (!ModelMatchesParams(models_[m], params)) ComputeModelViews(params, execution, &models_[m]);
  }
  if (!models_.empty()) descriptor_kind_ = models_.front().descriptor_kind;

  ListFeatures();
  if (params.method == Method::kPaper) {
    PreparePaperMethod(params);
  } else {
    PrepareDefaultMethod(params);
  }
}

void ModelDatabase::ListFeatures() {
  features_.resize(models_.size());
  for (std::size_t m = 0; m < models_.size(); ++m) {
    for (std::size_t v = 0; v < models_[m].views.size(); ++v) {
      for (const Feature& feature : models_[m].views[v].features) {
        origins_.push_back(
            {static_cast<int>(m), static_cast<int>(features_[m].size()), static_cast<int>(v)});
        features_[m].push_back(&feature);
      }
    }
  }
}

void ModelDatabase::PreparePaperMethod(const PipelineParams& params) {
  descriptors_ = std::make_unique<DescriptorIndex>(Descriptors(features_));
  for (const ObjectModel& model : models_)
    collision_shapes_.emplace_back(model, params.collisions.cell);
}

void ModelDatabase::PrepareDefaultMethod(const PipelineParams& params) {
  const std::vector<const Descriptor*> descriptors = Descriptors(features_);
  projection_ =
      std::make_unique<DescriptorProjection>(descriptors, params.matching.projected_dimensions);
  std::vector<Descriptor> projected;
  projected.reserve(descriptors.size());
  for (const Descriptor* descriptor : descriptors)
    projected.push_back(projection_->Project(*descriptor));
  std::vector<const Descriptor*> pointers;
  pointers.reserve(projected.size());
  for (const Descriptor& descriptor : projected) pointers.push_back(&descriptor);
  projected_descriptors_ = std::make_unique<DescriptorIndex>(pointers);
  for (const ObjectModel& model : models_) {
    ranking_models_.push_back(MakeRankingModel(model));
    judged_models_.emplace_back(model);
  }
}

}  // namespace rimod
