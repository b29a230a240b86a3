#include "rimod/candidate_judging.h"

#include <algorithm>

#include "rimod/judgement.h"
#include "rimod/refinement.h"

namespace rimod {
namespace {

double Odds(double probability) { return probability / std::max(1e-9, 1.0 - probability); }

// Refines ranked hypotheses and judges them by all evidence.
class Judge {
 public:
  Judge(const Scene& scene, const FeatureSet& features, const ModelMatches& matches,
        const ModelDatabase& database, const PipelineParams& params)
      : scene_(scene),
        database_(database),
        params_(params),
        support_(features, matches, database) {}

  JudgedCandidate Judged(const Hypothesis& ranked) const {
    JudgedCandidate result;
    result.candidate.model = ranked.model;
    result.rank_score = ranked.score;
    result.origin = ranked.origin;
    result.figures = ranked.figures;
    const JudgedModel& model = database_.judged_models()[ranked.model];
    const RefinementParams& refinement = params_.refinement;
    const Eigen::Isometry3f first = RefinePose(
        scene_, model.coarse_sample(), ranked.T_sensor_object, refinement.BeforeScreening());
    const double min_score = params_.ranking.min_screened_score;
    if (min_score > 0.0 && ranked.figures.pixels_across >= params_.ranking.min_coarse_pixels) {
      constexpr double kFarBelow = 0.1;  // a quarter of the pixels is less sure
      JudgeAt(first, GatherCoarseEvidence, &result);
      if (result.candidate.score < kFarBelow * min_score) return result;
    }
    JudgeAt(first, GatherEvidence, &result);
    if (result.candidate.score < min_score) return result;
    const RefinementSchedule schedule = refinement.BeforeJudging();
    const Eigen::Isometry3f refined = RefinePose(scene_, model.sample(), first, schedule);
    JudgeAt(refined, GatherEvidence, &result);
    if (static_cast<double>(TiltOf(refined)) >= refinement.upright_tilt) return result;
    JudgedCandidate upright = result;
    JudgeAt(StandUpright(scene_, model.sample(), refined, schedule), GatherEvidence, &upright);
    const double odds = Odds(upright.candidate.score) * refinement.min_leaning_odds;
    return Odds(result.candidate.score) > odds ? result : upright;
  }

 private:
  void JudgeAt(const Eigen::Isometry3f& T_sensor_object, decltype(&GatherEvidence) gather,
               JudgedCandidate* result) const {
    Candidate& candidate = result->candidate;
    candidate.T_sensor_object = T_sensor_object.cast<double>();
    result->evidence = gather(scene_, database_.judged_models()[candidate.model],
                              candidate.T_sensor_object, params_.evidence);
    result->support = support_.Count(candidate);
    candidate.score = Probability(
        kJudgementTrees, JudgementFigures(result->evidence, result->figures, result->support));
  }

  const Scene& scene_;
  const ModelDatabase& database_;
  const PipelineParams& params_;
  FeatureSupportCounter support_;
};

}  // namespace

std::vector<JudgedCandidate> JudgeCandidates(const Scene& scene, const FeatureSet& features,
                                             const ModelMatches& matches,
                                             const std::vector<Hypothesis>& ranked,
                                             const ModelDatabase& database,
                                             const PipelineParams& params,
                                             const Execution& execution) {
  const StageScope stage(execution, "validation");
  const Judge judge(scene, features, matches, database, params);
  std::vector<JudgedCandidate> judged(ranked.size());
  execution.parallel_for(ranked.size(),
                         [&](std::size_t i) { judged[i] = judge.Judged(ranked[i]); });
  std::stable_sort(judged.begin(), judged.end(),
                   [](const JudgedCandidate& a, const JudgedCandidate& b) {
                     return a.candidate.score > b.candidate.score;
                   });
  return judged;
}

}  // namespace rimod
