#include "rimod/model_work.h"

#include <algorithm>
#include <cmath>

namespace rimod {
namespace {

// With more models than full_models each gets this power of full_models over their number: a
// hundred cost about four times what seven do, and lose least that way (docs/benchmarks.md).
constexpr double kShareExponent = 0.65;

// Of a feature with each model: a single one loses too many objects.
constexpr int kFewestMatches = 2;

// Times the matches and checks of a feature where a scene has few.
constexpr double kMostMatches = 5.0;

}  // namespace

PipelineParams SharedAmongModels(const PipelineParams& params, int num_models) {
  PipelineParams shared = params;
  RankingParams& ranking = shared.ranking;
  if (ranking.num_models > 0) num_models = ranking.num_models;
  if (num_models <= ranking.full_models) return shared;
  const double share =
      std::pow(static_cast<double>(ranking.full_models) / num_models, kShareExponent);
  for (int* const count :
       {&shared.matching.max_matches, &shared.matching.max_checks,
        &shared.matching.min_correspondences, &ranking.max_scanned, &ranking.refined.always,
        &ranking.refined.most, &ranking.judged.always, &ranking.judged.most})
    *count = static_cast<int>(std::ceil(share * *count));
  shared.matching.max_matches =
      std::max(shared.matching.max_matches, std::min(kFewestMatches, params.matching.max_matches));
  // The more models, the less probable each candidate is; but what may be reported is looked at.
  const double most = std::max(ranking.min_screened_score, params.choice.min_probability);
  ranking.min_screened_score = std::min(ranking.min_screened_score / share, most);
  return shared;
}

MatchingParams ForFeatures(MatchingParams params, int num_features) {
  const double wanted = static_cast<double>(params.min_correspondences) / std::max(num_features, 1);
  const double factor = std::clamp(wanted / params.max_matches, 1.0, kMostMatches);
  params.max_matches = static_cast<int>(std::lround(factor * params.max_matches));
  params.max_checks = static_cast<int>(std::lround(factor * params.max_checks));
  return params;
}

std::vector<Hypothesis> BestOfEachModel(const std::vector<Hypothesis>& hypotheses,
                                        const ModelQuota& quota) {
  std::vector<Hypothesis> best;
  int model = -1, kept = 0;
  for (const Hypothesis& hypothesis : hypotheses) {
    if (hypothesis.model != model) kept = 0;
    model = hypothesis.model;
    if (kept >= (hypothesis.score < quota.min_score ? quota.always : quota.most)) continue;
    best.push_back(hypothesis);
    ++kept;
  }
  return best;
}

}  // namespace rimod
