#include "rimod/default_method.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "rimod/judgement.h"
#include "rimod/matching.h"
#include "rimod/refinement.h"
#include "rimod/single_correspondence.h"

namespace rimod {
namespace {

// Rounds that parallel loops over very many small pieces are cut into.
constexpr std::size_t kBatches = 64;

struct Hypothesis {
  int model = 0;
  Eigen::Isometry3f T_sensor_object = Eigen::Isometry3f::Identity();
  double score = 0.0;
  RankingFigures figures;
};

// Indices by falling score, ties by index.
template <typename List>
std::vector<int> OrderByScore(const List& list) {
  std::vector<int> order(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return list[a].score > list[b].score; });
  return order;
}

std::vector<Correspondence> Match(const FeatureSet& features, const ModelDatabase& database,
                                  const PipelineParams& params, const Execution& execution) {
  const StageScope stage(execution, "matching");
  std::vector<Feature> projected(features.features.size());
  for (std::size_t i = 0; i < projected.size(); ++i)
    projected[i].descriptor = database.projection().Project(features.features[i].descriptor);
  return MatchFeatures(projected, database.projected_descriptors(), params.matching, execution);
}

std::vector<Hypothesis> PosesFromCorrespondences(const std::vector<Correspondence>& matches,
                                                 const FeatureSet& features,
                                                 const ModelDatabase& database,
                                                 const PipelineParams& params,
                                                 const Execution& execution) {
  const StageScope stage(execution, "hypotheses");
  std::vector<Hypothesis> hypotheses;
  hypotheses.reserve(matches.size());
  for (const Correspondence& match : matches) {
    const ModelDatabase::FeatureOrigin& origin = database.origin(match.model_feature);
    const Feature& model_feature = *database.features(origin.model)[origin.feature];
    const Eigen::Vector3d line_of_sight =
        model_feature.position.cast<double>() -
        database.models()[origin.model].views[origin.view].viewpoint;
    const std::optional<Eigen::Isometry3d> pose = PoseFromCorrespondence(
        features.features[match.scene_feature], model_feature, line_of_sight,
        params.range_patch.max_vertical_cosine, params.ranking.min_normal_cosine);
    if (pose) hypotheses.push_back({origin.model, pose->cast<float>(), 0.0, {}});
  }
  return hypotheses;
}

// Scores all hypotheses before refinement, each on its own.
void ScoreHypotheses(const Scene& scene, const ModelDatabase& database,
                     const PipelineParams& params, const Execution& execution,
                     std::vector<Hypothesis>* hypotheses) {
  const StageScope stage(execution, "scoring");
  execution.parallel_for(kBatches, [&](std::size_t batch) {
    for (std::size_t i = batch; i < hypotheses->size(); i += kBatches) {
      Hypothesis& hypothesis = (*hypotheses)[i];
      const double score =
          RankingScore(scene, database.ranking_models()[hypothesis.model],
                       hypothesis.T_sensor_object, params.ranking.coarse_epsilon, params.ranking);
      const double pixels = PixelsAcross(scene, database.models()[hypothesis.model],
                                         hypothesis.T_sensor_object.cast<double>());
      hypothesis.score =
          std::max(score, 0.0) / (1.0 + params.ranking.pixels_half / (pixels * pixels));
    }
  });
}

// Best first the hypotheses whose pose differs from all better ones of their model.
std::vector<Hypothesis> DifferentPoses(const std::vector<Hypothesis>& hypotheses,
                                       const ModelDatabase& database, int max_count,
                                       const RankingParams& params) {
  const float distance_sq = static_cast<float>(params.same_distance * params.same_distance);
  const float min_trace = 1.0f + 2.0f * static_cast<float>(std::cos(params.same_angle));
  std::vector<Hypothesis> kept;
  std::vector<Eigen::Vector3f> centres;
  for (const int i : OrderByScore(hypotheses)) {
    const Hypothesis& hypothesis = hypotheses[i];
    if (hypothesis.score <= 0.0 || static_cast<int>(kept.size()) >= max_count) break;
    const Eigen::Vector3f centre =
        hypothesis.T_sensor_object * database.ranking_models()[hypothesis.model].centre;
    bool is_new = true;
    for (std::size_t k = 0; k < kept.size() && is_new; ++k) {
      is_new =
          kept[k].model != hypothesis.model || (centres[k] - centre).squaredNorm() >= distance_sq ||
          kept[k].T_sensor_object.linear().cwiseProduct(hypothesis.T_sensor_object.linear()).sum() <
              min_trace;
    }
    if (!is_new) continue;
    kept.push_back(hypothesis);
    centres.push_back(centre);
  }
  return kept;
}

// Upright ICP with the nearest view's points, then the score that was learnt.
void RefineAndRank(const Scene& scene, const ModelDatabase& database, const PipelineParams& params,
                   const Execution& execution, std::vector<Hypothesis>* hypotheses) {
  const StageScope stage(execution, "refinement");
  const RefinementParams& refinement = params.refinement;
  execution.parallel_for(hypotheses->size(), [&](std::size_t i) {
    Hypothesis& hypothesis = (*hypotheses)[i];
    const RankingModel& model = database.ranking_models()[hypothesis.model];
    const int view = NearestView(model, hypothesis.T_sensor_object);
    hypothesis.score = 0.0;
    if (view < 0) return;
    hypothesis.T_sensor_object =
        RefinePose(scene, model.views[view].surface, hypothesis.T_sensor_object, Freedom::kUpright,
                   refinement.coarse_iterations, refinement.coarse_gate, refinement.fine_gate,
                   refinement.damping, refinement.tilt_damping);
    const std::optional<RankingFigures> figures = CompareViewPoints(
        scene, model, hypothesis.T_sensor_object, params.ranking.fine_epsilon, params.ranking);
    if (!figures) return;
    hypothesis.figures = *figures;
    hypothesis.score =
        Probability(kRankWeights,
                    RankFigures(*figures, PixelsAcross(scene, database.models()[hypothesis.model],
                                                       hypothesis.T_sensor_object.cast<double>())));
  });
}

// The share of a candidate's pixels that are explained already.
double ExplainedShare(const Evidence& evidence, const std::vector<char>& explained) {
  if (evidence.explained.empty()) return 1.0;
  const auto count = std::count_if(evidence.explained.begin(), evidence.explained.end(),
                                   [&](int pixel) { return explained[pixel] != 0; });
  return static_cast<double>(count) / static_cast<double>(evidence.explained.size());
}

}  // namespace

std::vector<RankedCandidate> RankCandidates(const Scene& scene, const FeatureSet& features,
                                            const ModelDatabase& database,
                                            const PipelineParams& params,
                                            const Execution& execution, int* num_found) {
  std::vector<Hypothesis> hypotheses = PosesFromCorrespondences(
      Match(features, database, params, execution), features, database, params, execution);
  *num_found = static_cast<int>(hypotheses.size());
  ScoreHypotheses(scene, database, params, execution, &hypotheses);
  hypotheses = DifferentPoses(hypotheses, database, params.ranking.max_refined, params.ranking);
  RefineAndRank(scene, database, params, execution, &hypotheses);
  hypotheses = DifferentPoses(hypotheses, database, params.ranking.max_judged, params.ranking);
  std::vector<RankedCandidate> ranked;
  for (const Hypothesis& hypothesis : hypotheses) {
    ranked.push_back(
        {{hypothesis.model, hypothesis.T_sensor_object.cast<double>(), hypothesis.score},
         hypothesis.figures});
  }
  return ranked;
}

std::vector<JudgedCandidate> JudgeCandidates(const Scene& scene,
                                             const std::vector<RankedCandidate>& ranked,
                                             const ModelDatabase& database,
                                             const PipelineParams& params,
                                             const Execution& execution) {
  const StageScope stage(execution, "validation");
  const RefinementParams& refinement = params.refinement;
  std::vector<JudgedCandidate> judged(ranked.size());
  execution.parallel_for(ranked.size(), [&](std::size_t i) {
    JudgedCandidate& result = judged[i];
    result.candidate = ranked[i].candidate;
    result.figures = ranked[i].figures;
    const JudgedModel& model = database.judged_models()[result.candidate.model];
    result.candidate.T_sensor_object =
        RefinePose(scene, model.sample(), result.candidate.T_sensor_object.cast<float>(),
                   Freedom::kAll, refinement.fine_iterations, refinement.judged_first_gate,
                   refinement.judged_last_gate, refinement.damping, refinement.tilt_damping)
            .cast<double>();
    result.evidence =
        GatherEvidence(scene, model, result.candidate.T_sensor_object, params.evidence);
    result.candidate.score =
        Probability(kJudgementTrees, JudgementFigures(result.evidence, result.figures));
  });
  std::stable_sort(judged.begin(), judged.end(),
                   [](const JudgedCandidate& a, const JudgedCandidate& b) {
                     return a.candidate.score > b.candidate.score;
                   });
  return judged;
}

std::vector<Candidate> ChooseCandidates(const Scene& scene,
                                        const std::vector<JudgedCandidate>& judged,
                                        const ModelDatabase& database, const PipelineParams& params,
                                        const Execution& execution) {
  const StageScope stage(execution, "collisions");
  std::vector<char> explained(static_cast<std::size_t>(scene.grid().size()), 0);
  std::vector<Candidate> chosen;
  for (const JudgedCandidate& judgement : judged) {
    const Candidate& candidate = judgement.candidate;
    if (candidate.score < params.choice.min_probability) break;
    if (ExplainedShare(judgement.evidence, explained) > params.choice.max_explained_share) continue;
    const ObjectModel& model = database.models()[candidate.model];
    const auto centre = [&](const Candidate& c) -> Eigen::Vector3d {
      const ObjectModel& m = database.models()[c.model];
      return c.T_sensor_object * Eigen::Vector3d(0.5 * (m.box_min + m.box_max));
    };
    const bool too_near = std::any_of(chosen.begin(), chosen.end(), [&](const Candidate& better) {
      const double diameter =
          std::min(model.Diameter(), database.models()[better.model].Diameter());
      const double share = better.model == candidate.model ? params.choice.same_class_distance
                                                           : params.choice.other_class_distance;
      return (centre(better) - centre(candidate)).norm() < share * diameter;
    });
    if (too_near) continue;
    for (const int pixel : judgement.evidence.explained) explained[pixel] = 1;
    chosen.push_back(candidate);
  }
  return chosen;
}

StagedCandidates FindByEvidence(const RangeImage& image, const FeatureSet& features,
                                const ModelDatabase& database, const PipelineParams& params,
                                const Execution& execution) {
  const Scene scene = [&] {
    const StageScope stage(execution, "scene_normals");
    return Scene(image, params.evidence.normal_radius, execution);
  }();
  StagedCandidates found;
  const std::vector<RankedCandidate> ranked =
      RankCandidates(scene, features, database, params, execution, &found.num_found);
  const std::vector<JudgedCandidate> judged =
      JudgeCandidates(scene, ranked, database, params, execution);
  found.validated = ChooseCandidates(scene, judged, database, params, execution);
  for (const JudgedCandidate& candidate : judged) found.scored.push_back(candidate.candidate);
  return found;
}

}  // namespace rimod
