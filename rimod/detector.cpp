#include "rimod/detector.h"

#include <stdexcept>
#include <string>

#include "rimod/paper_method.h"

namespace rimod {
namespace {

void RequireFitting(const FeatureSet& features, const ModelDatabase& database,
                    const PipelineParams& params) {
  const std::string kind = DescriptorKind(params);
  if (features.descriptor_kind != kind) {
    throw std::invalid_argument("features are of kind '" + features.descriptor_kind + "', not '" +
                                kind + "'");
  }
  if (database.method() != params.method)
    throw std::invalid_argument("the model database was prepared for another method");
}

}  // namespace

RangeImage ComputeRangeImage(const Scan& scan, const PipelineParams& params,
                             const Execution& execution) {
  const StageScope stage(execution, "range_image");
  return MakeRangeImage(scan, params.range_image, execution);
}

DetectionResult DetectObjects(const RangeImage& image, const FeatureSet& features,
                              const ModelDatabase& database, const PipelineParams& params,
                              const Execution& execution, std::optional<EarlierLook>* earlier) {
  if (params.method == Method::kDefault) {
    const JudgedScan judged = JudgeObjects(image, features, database, params, execution, earlier);
    const StageScope stage(execution, "collisions");
    return ChooseDetections(judged, params);
  }
  RequireFitting(features, database, params);
  return ToResult(FindByTriples(image, features, database, params, execution),
                  CandidateModelsOf(database.models()), image.T_local_sensor(),
                  params.max_reported_hypotheses);
}

JudgedScan JudgeObjects(const RangeImage& image, const FeatureSet& features,
                        const ModelDatabase& database, const PipelineParams& params,
                        const Execution& execution, std::optional<EarlierLook>* earlier) {
  RequireFitting(features, database, params);
  if (params.method != Method::kDefault)
    throw std::invalid_argument("only the default method judges each model by itself");
  return FindByEvidence(image, features, database, params, execution, earlier);
}

}  // namespace rimod
