#include "rimod/default_method.h"

#include <algorithm>
#include <optional>

#include "rimod/distinct_poses.h"
#include "rimod/judgement.h"
#include "rimod/matching.h"
#include "rimod/model_work.h"
#include "rimod/refinement.h"
#include "rimod/single_correspondence.h"

namespace rimod {
namespace {

// Rounds that parallel loops over very many small pieces are cut into.
constexpr std::size_t kBatches = 64;

// Indices by falling score, ties by index.
template <typename List>
std::vector<int> OrderByScore(const List& list) {
  std::vector<int> order(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return list[a].score > list[b].score; });
  return order;
}

// Of one model's correspondences.
std::vector<Hypothesis> PosesFromCorrespondences(const std::vector<Correspondence>& matches,
                                                 const FeatureSet& features,
                                                 const ModelDatabase& database,
                                                 const PipelineParams& params) {
  std::vector<Hypothesis> hypotheses;
  hypotheses.reserve(matches.size());
  for (const Correspondence& match : matches) {
    const ModelDatabase::PlacedFeature& model_feature = database.feature(match.model_feature);
    const Eigen::Vector3d line_of_sight =
        model_feature.position.cast<double>() -
        database.models()[model_feature.model].views[model_feature.view].viewpoint;
    const Feature& scene_feature = features.features[match.scene_feature];
    const std::optional<Eigen::Isometry3d> upright = PoseFromCorrespondence(
        scene_feature, model_feature, line_of_sight, params.range_patch.max_vertical_cosine,
        params.ranking.min_normal_cosine);
    if (!upright) continue;
    const auto add = [&](const Eigen::Isometry3d& pose) {
      Hypothesis hypothesis;
      hypothesis.model = model_feature.model;
      hypothesis.T_sensor_object = pose.cast<float>();
      hypothesis.figures.descriptor_distance = static_cast<float>(match.distance);
      hypotheses.push_back(hypothesis);
    };
    add(*upright);
    const std::optional<Eigen::Isometry3d> tilted = TiltedToNormal(
        *upright, scene_feature, model_feature, params.ranking.min_tilt, params.ranking.max_tilt);
    if (tilted) add(*tilted);
  }
  return hypotheses;
}

// Sets the figures of a hypothesis at its pose; false when it is hopeless.
bool SetFigures(const Scene& scene, const ModelDatabase& database, ViewComparison* comparison,
                Hypothesis* hypothesis) {
  RankingFigures& figures = hypothesis->figures;
  const Eigen::Isometry3f& pose = hypothesis->T_sensor_object;
  if (!comparison->Compare(database.ranking_models()[hypothesis->model], pose, &figures))
    return false;
  figures.tilt = TiltOf(pose);
  figures.pixels_across = static_cast<float>(
      PixelsAcross(scene, database.models()[hypothesis->model], pose.cast<double>()));
  return true;
}

// Scores all models' hypotheses before refinement, each on its own; not those without news.
void ScoreHypotheses(const Scene& scene, const ModelDatabase& database, const RankingParams& params,
                     const Execution& execution, const ImageChange& change,
                     std::vector<std::vector<Hypothesis>>* of_models) {
  execution.parallel_for(kBatches, [&](std::size_t batch) {
    ViewComparison comparison(scene, params.coarse_epsilon, params);
    for (std::vector<Hypothesis>& hypotheses : *of_models) {
      for (std::size_t i = batch; i < hypotheses.size(); i += kBatches) {
        Hypothesis& hypothesis = hypotheses[i];
        if (!HasNews(change, database.models()[hypothesis.model], hypothesis.T_sensor_object))
          continue;
        if (SetFigures(scene, database, &comparison, &hypothesis))
          hypothesis.score = Probability(kProposalWeights, RankFigures(hypothesis.figures));
      }
    }
  });
}

// Best first a model's hypotheses whose pose differs from all better ones; the others give these
// their votes. Looks at the max_scanned best.
std::vector<Hypothesis> DifferentPoses(const std::vector<Hypothesis>& hypotheses,
                                       const ModelDatabase& database, int max_scanned,
                                       const RankingParams& params) {
  std::vector<Hypothesis> different;
  DistinctPoses distinct(params.same_distance, params.same_angle);
  int scanned = 0;
  for (const int i : OrderByScore(hypotheses)) {
    const Hypothesis& hypothesis = hypotheses[i];
    if (hypothesis.score <= 0.0 || scanned++ >= max_scanned) break;
    const Eigen::Vector3f centre =
        hypothesis.T_sensor_object * database.ranking_models()[hypothesis.model].centre;
    if (!centre.allFinite()) continue;
    const int same = distinct.FindOrAdd(hypothesis.T_sensor_object, centre);
    if (same < static_cast<int>(different.size())) {
      different[same].figures.votes += hypothesis.figures.votes;
    } else {
      different.push_back(hypothesis);
    }
  }
  return different;
}

// Best first, scored with their votes.
std::vector<Hypothesis> ByScoreWithVotes(std::vector<Hypothesis> hypotheses,
                                         const LogisticWeights& weights) {
  for (Hypothesis& hypothesis : hypotheses)
    hypothesis.score = Probability(weights, RankFigures(hypothesis.figures));
  std::vector<Hypothesis> sorted;
  sorted.reserve(hypotheses.size());
  for (const int i : OrderByScore(hypotheses)) sorted.push_back(hypotheses[i]);
  return sorted;
}

// Each model's hypotheses, in their order.
std::vector<std::vector<Hypothesis>> OfEachModel(const std::vector<Hypothesis>& hypotheses,
                                                 const ModelDatabase& database) {
  std::vector<std::vector<Hypothesis>> of_models(database.models().size());
  for (const Hypothesis& hypothesis : hypotheses) of_models[hypothesis.model].push_back(hypothesis);
  return of_models;
}

// Of each model different poses, scored with their votes; model after model, best first.
std::vector<Hypothesis> RankEachModel(const std::vector<std::vector<Hypothesis>>& of_models,
                                      const ModelDatabase& database, int max_scanned,
                                      const LogisticWeights& weights, const RankingParams& params,
                                      const Execution& execution) {
  std::vector<std::vector<Hypothesis>> ranked(of_models.size());
  execution.parallel_for(of_models.size(), [&](std::size_t m) {
    ranked[m] =
        ByScoreWithVotes(DifferentPoses(of_models[m], database, max_scanned, params), weights);
  });
  std::vector<Hypothesis> all;
  for (const std::vector<Hypothesis>& list : ranked)
    all.insert(all.end(), list.begin(), list.end());
  return all;
}

// ICP with the nearest view's points, then the score that was learnt.
void RefineAndRank(const Scene& scene, const ModelDatabase& database, const PipelineParams& params,
                   const Execution& execution, std::vector<Hypothesis>* hypotheses) {
  const RefinementSchedule schedule = params.refinement.BeforeRanking();
  execution.parallel_for(hypotheses->size(), [&](std::size_t i) {
    Hypothesis& hypothesis = (*hypotheses)[i];
    const RankingModel& model = database.ranking_models()[hypothesis.model];
    const int view = NearestView(model, hypothesis.T_sensor_object);
    hypothesis.score = 0.0;
    if (view < 0) return;
    hypothesis.T_sensor_object =
        RefinePose(scene, model.views[view].surface, hypothesis.T_sensor_object, schedule);
    ViewComparison comparison(scene, params.ranking.fine_epsilon, params.ranking);
    if (SetFigures(scene, database, &comparison, &hypothesis))
      hypothesis.score = Probability(kRankWeights, RankFigures(hypothesis.figures));
  });
}

}  // namespace

ModelMatches MatchToModels(const FeatureSet& features, const ModelDatabase& database,
                           const PipelineParams& params, const Execution& execution,
                           const KnownMatches* known) {
  const StageScope stage(execution, "matching");
  const std::vector<int> known_as =
      known ? FindKnown(features, known->features) : std::vector<int>(features.features.size(), -1);
  std::vector<int> unknown;
  for (std::size_t i = 0; i < known_as.size(); ++i)
    if (known_as[i] < 0) unknown.push_back(static_cast<int>(i));
  std::vector<Feature> projected(unknown.size());
  execution.parallel_for(kBatches, [&](std::size_t batch) {
    for (std::size_t i = batch; i < projected.size(); i += kBatches) {
      projected[i].descriptor =
          database.projection().Project(features.features[unknown[i]].descriptor);
    }
  });
  const MatchingParams matching =
      ForFeatures(params.matching, static_cast<int>(features.features.size()));
  ModelMatches matches(database.models().size());
  for (int m = 0; m < static_cast<int>(matches.size()); ++m) {
    matches[m] = MatchFeatures(projected, database.projected_descriptors(m), matching, execution);
    for (Correspondence& match : matches[m]) match.model_feature += database.first_feature(m);
    if (known) matches[m] = WithKnown(matches[m], known->matches[m], known_as);
  }
  return matches;
}

std::vector<Hypothesis> ProposeHypotheses(const Scene& scene, const FeatureSet& features,
                                          const ModelMatches& matches,
                                          const ModelDatabase& database,
                                          const PipelineParams& params, const Execution& execution,
                                          int* num_found, const ImageChange& change) {
  std::vector<std::vector<Hypothesis>> hypotheses(matches.size());
  {
    const StageScope stage(execution, "hypotheses");
    execution.parallel_for(matches.size(), [&](std::size_t m) {
      hypotheses[m] = PosesFromCorrespondences(matches[m], features, database, params);
    });
  }
  *num_found = 0;
  for (const std::vector<Hypothesis>& list : hypotheses)
    *num_found += static_cast<int>(list.size());
  const StageScope stage(execution, "scoring");
  const RankingParams& ranking = params.ranking;
  ScoreHypotheses(scene, database, ranking, execution, change, &hypotheses);
  return BestOfEachModel(RankEachModel(hypotheses, database, ranking.max_scanned, kProposalWeights,
                                       ranking, execution),
                         ranking.refined);
}

std::vector<Hypothesis> RankHypotheses(const Scene& scene, std::vector<Hypothesis> hypotheses,
                                       const ModelDatabase& database, const PipelineParams& params,
                                       const Execution& execution) {
  const StageScope stage(execution, "refinement");
  const RankingParams& ranking = params.ranking;
  RefineAndRank(scene, database, params, execution, &hypotheses);
  return BestOfEachModel(RankEachModel(OfEachModel(hypotheses, database), database,
                                       ranking.refined.most, kRankWeights, ranking, execution),
                         ranking.judged);
}

JudgedScan ToJudgedScan(const Scene& scene, const std::vector<JudgedCandidate>& judged,
                        const ModelDatabase& database, int num_found) {
  JudgedScan scan;
  scan.num_pixels = scene.grid().size();
  scan.T_local_sensor = scene.image().T_local_sensor();
  scan.num_found = num_found;
  scan.models = CandidateModelsOf(database.models());
  for (const JudgedCandidate& j : judged)
    scan.candidates.push_back({j.candidate, j.rank_score, RunsOf(j.evidence.explained)});
  return scan;
}

std::vector<Candidate> ChooseCandidates(const Scene& scene,
                                        const std::vector<JudgedCandidate>& judged,
                                        const ModelDatabase& database, const PipelineParams& params,
                                        const Execution& execution) {
  const StageScope stage(execution, "collisions");
  const JudgedScan scan = ToJudgedScan(scene, judged, database, static_cast<int>(judged.size()));
  return ChooseCandidates(scan, params.choice).validated;
}

JudgedScan FindByEvidence(const RangeImage& image, const FeatureSet& features,
                          const ModelDatabase& database, const PipelineParams& all_params,
                          const Execution& execution, std::optional<EarlierLook>* earlier) {
  const PipelineParams params =
      SharedAmongModels(all_params, static_cast<int>(database.models().size()));
  const EarlierLook* const before = earlier && *earlier ? &**earlier : nullptr;
  const ImageChange change = before ? ImageChange(before->scene.image(), image) : ImageChange();
  Scene scene = [&] {
    const StageScope stage(execution, "scene_normals");
    const double radius = params.evidence.normal_radius;
    return before ? Scene(image, radius, execution, before->scene, change)
                  : Scene(image, radius, execution);
  }();
  int num_found = 0;
  ModelMatches matches =
      MatchToModels(features, database, params, execution, before ? &before->known : nullptr);
  SettledHypotheses settled(before, change, database);
  const std::vector<Hypothesis> proposed = settled.Propose(
      ProposeHypotheses(scene, features, matches, database, params, execution, &num_found, change),
      params.ranking.refined);
  const std::vector<Hypothesis> ranked = settled.Rank(
      RankHypotheses(scene, proposed, database, params, execution), params.ranking.judged);
  const std::vector<JudgedCandidate> judged =
      JudgeCandidates(scene, features, matches, ranked, database, params, execution);
  JudgedScan found = ToJudgedScan(scene, judged, database, num_found);
  std::vector<int> origins;
  for (const JudgedCandidate& candidate : judged) origins.push_back(candidate.origin);
  settled.Judge(origins, &found);
  if (earlier) {
    earlier->emplace(
        EarlierLook{std::move(scene), {features, std::move(matches)}, settled.TakeHistories()});
  }
  return found;
}

}  // namespace rimod
