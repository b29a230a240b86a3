#include "viewer_tools/detector_trace.h"

#include <algorithm>

#include "rimod/feature_extraction.h"
#include "rimod/model_work.h"
#include "rimod/paper_method.h"

namespace rimod {
namespace {

// A pose that refinement is likely to pull to its place, and one that is there.
constexpr PoseError kNearby{0.20, 25.0};
constexpr PoseError kInPlace{0.10, 15.0};

CandidateList ToCandidates(const std::vector<Hypothesis>& hypotheses) {
  CandidateList candidates;
  candidates.reserve(hypotheses.size());
  for (const Hypothesis& h : hypotheses)
    candidates.push_back({h.model, h.T_sensor_object.cast<double>(), h.score});
  return candidates;
}

void TraceDefaultMethod(const Scene& scene, const ModelDatabase& database,
                        const PipelineParams& all_params, const Execution& execution,
                        DetectorTrace* trace) {
  const PipelineParams params =
      SharedAmongModels(all_params, static_cast<int>(database.models().size()));
  const RankingParams& ranking = params.ranking;
  trace->matches = MatchToModels(trace->features, database, params, execution);
  // More than the method itself keeps, so that what it drops can be seen.
  PipelineParams all = params;
  const int everything = std::max(ranking.max_scanned, ranking.refined.most);
  all.ranking.refined = all.ranking.judged = {everything, everything, 0.0};
  int num_found = 0;
  const std::vector<Hypothesis> proposed = ProposeHypotheses(scene, trace->features, trace->matches,
                                                             database, all, execution, &num_found);
  const std::vector<Hypothesis> kept = BestOfEachModel(proposed, ranking.refined);
  const std::vector<Hypothesis> refined = RankHypotheses(scene, kept, database, all, execution);
  const std::vector<Hypothesis> ranked = BestOfEachModel(refined, ranking.judged);
  trace->judged =
      JudgeCandidates(scene, trace->features, trace->matches, ranked, database, params, execution);
  trace->chosen = ChooseCandidates(scene, trace->judged, database, params, execution);

  CandidateList judged, probable;
  for (const JudgedCandidate& j : trace->judged) {
    judged.push_back(j.candidate);
    if (j.candidate.score >= params.choice.min_probability) probable.push_back(j.candidate);
  }
  trace->stages = {
      {"not proposed", kNearby, ToCandidates(proposed)},
      {"ranked out before refinement", kNearby, ToCandidates(kept)},
      {"refined away", kInPlace, ToCandidates(refined)},
      {"ranked out after refinement", kInPlace, ToCandidates(ranked)},
      {"refined away", kInPlace, std::move(judged)},
      {"judged improbable", kInPlace, std::move(probable)},
      {"beaten by a better candidate", kInPlace, trace->chosen},
  };
}

void TracePaperMethod(const Scene& scene, const ModelDatabase& database,
                      const PipelineParams& params, const Execution& execution,
                      DetectorTrace* trace) {
  StagedCandidates found =
      FindByTriples(scene.image(), trace->features, database, params, execution);
  trace->chosen = found.validated;
  trace->stages = {
      {"no pose with a score", kNearby, std::move(found.scored)},
      {"pruned or refined away", kInPlace, std::move(found.pruned)},
      {"not validated, or collided", kInPlace, std::move(found.validated)},
  };
}

// Median descriptor distance of the correspondences, m; 0 without any.
float MedianDistance(const std::vector<Correspondence>& matches) {
  if (matches.empty()) return 0.0f;
  std::vector<double> distances;
  distances.reserve(matches.size());
  for (const Correspondence& match : matches) distances.push_back(match.distance);
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return static_cast<float>(*middle);
}

}  // namespace

DetectorTrace TraceDetector(const Scene& scene, const ModelDatabase& database,
                            const PipelineParams& params, const Execution& execution) {
  DetectorTrace trace;
  trace.features = ExtractFeatures(scene.image(), params, execution);
  if (params.method == Method::kPaper) {
    TracePaperMethod(scene, database, params, execution, &trace);
  } else {
    TraceDefaultMethod(scene, database, params, execution, &trace);
  }
  return trace;
}

std::optional<JudgedCandidate> JudgePose(const Scene& scene, const DetectorTrace& trace,
                                         const Candidate& candidate, const ModelDatabase& database,
                                         const PipelineParams& params, const Execution& execution) {
  Hypothesis hypothesis;
  hypothesis.model = candidate.model;
  hypothesis.T_sensor_object = candidate.T_sensor_object.cast<float>();
  hypothesis.figures.descriptor_distance = MedianDistance(trace.matches[candidate.model]);
  PipelineParams all = params;
  all.ranking.judged = {1, 1, 0.0};
  const std::vector<Hypothesis> ranked =
      RankHypotheses(scene, {hypothesis}, database, all, execution);
  const std::vector<JudgedCandidate> judged =
      JudgeCandidates(scene, trace.features, trace.matches, ranked, database, params, execution);
  if (judged.empty()) return std::nullopt;
  return judged.front();
}

}  // namespace rimod
