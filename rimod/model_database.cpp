#include "rimod/model_database.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "rimod/feature_extraction.h"

namespace rimod {
namespace {

// The descriptors of all features, in the list's order.
std::vector<const Descriptor*> Descriptors(const std::vector<ObjectModel>& models) {
  std::vector<const Descriptor*> descriptors;
  for (const ObjectModel& model : models)
    for (const ModelView& view : model.views)
      for (const Feature& feature : view.features) descriptors.push_back(&feature.descriptor);
  return descriptors;
}

void FreeLists(ModelView* view) {
  ModelView bare;
  bare.viewpoint = view->viewpoint;
  *view = std::move(bare);
}

}  // namespace

ModelDatabase::ModelDatabase(std::vector<ObjectModel> models, const PipelineParams& params,
                             const Execution& execution)
    : method_(params.method), models_(std::move(models)) {
  CheckDescriptor(params);
  PrepareModels(params, execution);
  if (!models_.empty()) descriptor_kind_ = models_.front().descriptor_kind;
  PlaceFeatures();
  if (params.method == Method::kPaper) {
    PreparePaperMethod(params, execution);
  } else {
    PrepareDefaultMethod(params, execution);
  }
}

void ModelDatabase::PrepareModels(const PipelineParams& params, const Execution& execution) {
  std::sort(models_.begin(), models_.end(),
            [](const ObjectModel& a, const ObjectModel& b) { return a.name < b.name; });
  execution.parallel_for(models_.size(), [&](std::size_t m) { ValidateModel(models_[m]); });
  for (std::size_t m = 0; m < models_.size(); ++m) {
    if (m > 0 && models_[m].name == models_[m - 1].name)
      throw std::invalid_argument("two models of the name " + models_[m].name);
    if (!ModelMatchesParams(models_[m], params)) ComputeModelViews(params, execution, &models_[m]);
  }
}

void ModelDatabase::PlaceFeatures() {
  std::size_t count = 0;
  for (const ObjectModel& model : models_)
    for (const ModelView& view : model.views) count += view.features.size();
  placed_features_.reserve(count);
  for (std::size_t m = 0; m < models_.size(); ++m) {
    first_features_.push_back(static_cast<int>(placed_features_.size()));
    for (std::size_t v = 0; v < models_[m].views.size(); ++v)
      for (const Feature& feature : models_[m].views[v].features)
        placed_features_.push_back(
            {{feature.position, feature.normal}, static_cast<int>(m), static_cast<int>(v)});
  }
  first_features_.push_back(static_cast<int>(placed_features_.size()));
}

void ModelDatabase::PreparePaperMethod(const PipelineParams& params, const Execution& execution) {
  descriptors_ = std::make_unique<DescriptorIndex>(Descriptors(models_), execution);
  features_.resize(models_.size());
  for (std::size_t m = 0; m < models_.size(); ++m)
    for (const ModelView& view : models_[m].views)
      for (const Feature& feature : view.features) features_[m].push_back(&feature);
  for (const ObjectModel& model : models_)
    collision_shapes_.emplace_back(model, params.collisions.cell);
}

void ModelDatabase::PrepareDefaultMethod(const PipelineParams& params, const Execution& execution) {
  projection_ = std::make_unique<DescriptorProjection>(params.range_patch.resolution,
                                                       params.matching.projected_dimensions);
  ranking_models_.resize(models_.size());
  std::vector<std::optional<JudgedModel>> judged(models_.size());
  std::vector<std::optional<DescriptorIndex>> indices(models_.size());
  execution.parallel_for(models_.size(), [&](std::size_t m) {
    ObjectModel& model = models_[m];
    std::vector<std::int16_t> projected;
    projected.reserve(static_cast<std::size_t>(first_features_[m + 1] - first_features_[m]) *
                      projection_->dimensions());
    for (const ModelView& view : model.views) {
      for (const Feature& feature : view.features) {
        const Descriptor values = projection_->Project(feature.descriptor);
        projected.insert(projected.end(), values.begin(), values.end());
      }
    }
    indices[m].emplace(std::move(projected), std::max(projection_->dimensions(), 1), Execution{});
    ranking_models_[m] = MakeRankingModel(model);
    for (ModelView& view : model.views) FreeLists(&view);
    judged[m].emplace(model);
  });
  for (std::optional<JudgedModel>& model : judged) judged_models_.push_back(std::move(*model));
  for (std::optional<DescriptorIndex>& index : indices)
    projected_descriptors_.push_back(std::move(*index));
}

}  // namespace rimod
