#include "benchmarks/peers/judge.h"

#include <algorithm>
#include <utility>

#include "rimod/detector.h"
#include "rimod/feature_extraction.h"

namespace rimod::peers {
namespace {

std::vector<ObjectModel> ByName(std::vector<ObjectModel> models) {
  std::sort(models.begin(), models.end(),
            [](const ObjectModel& a, const ObjectModel& b) { return a.name < b.name; });
  return models;
}

// As well as a good correspondence of our own would have it: others' descriptors are not ours.
constexpr float kDescriptorDistance = 0.03f;  // m

}  // namespace

Judge::Judge(std::vector<ObjectModel> models, const PipelineParams& params,
             const Execution& execution)
    : models_(ByName(std::move(models))),
      params_(params),
      execution_(execution),
      database_(models_, params, execution) {}

Judge::PreparedScan Judge::Prepare(const Scan& scan) const {
  const RangeImage image = ComputeRangeImage(scan, params_, execution_);
  FeatureSet features = ExtractFeatures(image, params_, execution_);
  ModelMatches matches = MatchToModels(features, database_, params_, execution_);
  return {Scene(image, params_.evidence.normal_radius, execution_), std::move(features),
          std::move(matches)};
}

std::vector<Detection> Judge::Choose(const PreparedScan& scan,
                                     const std::vector<Proposal>& proposals) const {
  const Eigen::Isometry3d T_sensor_local = scan.scene.image().T_local_sensor().inverse();
  std::vector<Hypothesis> hypotheses;
  for (const Proposal& proposal : proposals) {
    Hypothesis hypothesis;
    hypothesis.model = static_cast<int>(proposal.model);
    hypothesis.T_sensor_object = (T_sensor_local * proposal.T_scan_model).cast<float>();
    hypothesis.figures.descriptor_distance = kDescriptorDistance;
    hypotheses.push_back(hypothesis);
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.model < b.model; });
  const int num_found = static_cast<int>(hypotheses.size());
  const std::vector<Hypothesis> ranked =
      RankHypotheses(scan.scene, std::move(hypotheses), database_, params_, execution_);
  const std::vector<JudgedCandidate> judged = JudgeCandidates(
      scan.scene, scan.features, scan.matches, ranked, database_, params_, execution_);
  return ChooseDetections(ToJudgedScan(scan.scene, judged, database_, num_found), params_)
      .detections;
}

std::vector<Detection> BestOfEachPlace(std::vector<Proposal> proposals,
                                       const std::vector<ObjectModel>& models) {
  std::stable_sort(proposals.begin(), proposals.end(),
                   [](const Proposal& a, const Proposal& b) { return a.measure > b.measure; });
  const auto centre = [&](const Proposal& p) -> Eigen::Vector3d {
    return p.T_scan_model * (0.5 * (models[p.model].box_min + models[p.model].box_max));
  };
  std::vector<Proposal> best;
  for (const Proposal& proposal : proposals) {
    if (proposal.measure < 0.0) break;
    const bool taken = std::any_of(best.begin(), best.end(), [&](const Proposal& other) {
      const double near =
          0.25 * std::min(models[proposal.model].Diameter(), models[other.model].Diameter());
      return (centre(proposal) - centre(other)).norm() < near;
    });
    if (!taken) best.push_back(proposal);
  }
  std::vector<Detection> detections;
  for (const Proposal& p : best) {
    const ObjectModel& model = models[p.model];
    detections.push_back({model.name, p.T_scan_model, model.box_min, model.box_max, p.measure});
  }
  return detections;
}

}  // namespace rimod::peers
