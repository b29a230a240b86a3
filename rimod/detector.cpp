#include "rimod/detector.h"

#include <algorithm>
#include <stdexcept>

#include "rimod/default_method.h"
#include "rimod/paper_method.h"

namespace rimod {
namespace {

// The candidates of a later stage first, each listed with the last stage that it passed.
void ReportHypotheses(const RangeImage& image, const ModelDatabase& database,
                      const std::vector<std::pair<HypothesisStage, const CandidateList*>>& stages,
                      int max_reported, DetectionResult* result) {
  const auto same = [](const Candidate& a, const Candidate& b) {
    return a.model == b.model && a.T_sensor_object.matrix() == b.T_sensor_object.matrix();
  };
  CandidateList reported;
  for (const auto& [stage, candidates] : stages) {
    for (const Candidate& candidate : *candidates) {
      if (static_cast<int>(reported.size()) >= max_reported) return;
      if (std::any_of(reported.begin(), reported.end(),
                      [&](const Candidate& other) { return same(candidate, other); }))
        continue;
      reported.push_back(candidate);
      result->hypotheses.push_back({database.models()[candidate.model].name,
                                    image.T_local_sensor() * candidate.T_sensor_object,
                                    candidate.score, stage});
    }
  }
}

Detection ToDetection(const RangeImage& image, const ModelDatabase& database,
                      const Candidate& candidate) {
  const ObjectModel& model = database.models()[candidate.model];
  return {model.name, image.T_local_sensor() * candidate.T_sensor_object, model.box_min,
          model.box_max, candidate.score};
}

}  // namespace

RangeImage ComputeRangeImage(const Scan& scan, const PipelineParams& params,
                             const Execution& execution) {
  const StageScope stage(execution, "range_image");
  return MakeRangeImage(scan, params.range_image);
}

DetectionResult DetectObjects(const RangeImage& image, const FeatureSet& features,
                              const ModelDatabase& database, const PipelineParams& params,
                              const Execution& execution) {
  if (features.descriptor_kind != params.range_patch.Kind()) {
    throw std::invalid_argument("features are of kind '" + features.descriptor_kind + "', not '" +
                                params.range_patch.Kind() + "'");
  }
  if (database.method() != params.method)
    throw std::invalid_argument("the model database was prepared for another method");
  const StagedCandidates found = params.method == Method::kPaper
                                     ? FindByTriples(image, features, database, params, execution)
                                     : FindByEvidence(image, features, database, params, execution);

  DetectionResult result;
  result.num_hypotheses_found = found.num_found;
  for (const Candidate& candidate : found.validated)
    result.detections.push_back(ToDetection(image, database, candidate));
  ReportHypotheses(image, database,
                   {{HypothesisStage::kValidated, &found.validated},
                    {HypothesisStage::kNoCollision, &found.collision_free},
                    {HypothesisStage::kPruned, &found.pruned},
                    {HypothesisStage::kScored, &found.scored}},
                   params.max_reported_hypotheses, &result);
  return result;
}

}  // namespace rimod
