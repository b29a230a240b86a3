#include "rimod/paper_method.h"

#include <algorithm>

#include "rimod/goodsac.h"
#include "rimod/matching.h"
#include "rimod/refinement.h"
#include "rimod/scene.h"
#include "rimod/scoring.h"

namespace rimod {
namespace {

using CandidateList = std::vector<Candidate>;

std::vector<std::vector<Eigen::Isometry3d>> GeneratePoses(const ModelMatches& correspondences,
                                                          const FeatureSet& features,
                                                          const ModelDatabase& database,
                                                          const PipelineParams& params,
                                                          const Execution& execution) {
  const StageScope stage(execution, "hypotheses");
  std::vector<std::vector<Eigen::Isometry3d>> poses(correspondences.size());
  execution.parallel_for(poses.size(), [&](std::size_t m) {
    poses[m] = CandidatePoses(correspondences[m], features.features,
                              database.features(static_cast<int>(m)), params.goodsac);
  });
  return poses;
}

CandidateList ScorePoses(const RangeImage& image,
                         const std::vector<std::vector<Eigen::Isometry3d>>& poses,
                         const ModelDatabase& database, const PipelineParams& params,
                         const Execution& execution) {
  const StageScope stage(execution, "scoring");
  std::vector<CandidateList> scored(poses.size());
  execution.parallel_for(poses.size(), [&](std::size_t m) {
    for (const Eigen::Isometry3d& pose : poses[m]) {
      const double score = ScorePose(image, database.models()[m], pose, params.scoring);
      if (score >= params.scoring.gamma) scored[m].push_back({static_cast<int>(m), pose, score});
    }
  });
  CandidateList all;
  for (const CandidateList& list : scored) all.insert(all.end(), list.begin(), list.end());
  return all;
}

CandidateList ValidateCandidates(const RangeImage& image, const CandidateList& candidates,
                                 const ModelDatabase& database, const PipelineParams& params,
                                 const Execution& execution) {
  const StageScope stage(execution, "validation");
  CandidateList validated = candidates;
  execution.parallel_for(validated.size(), [&](std::size_t i) {
    validated[i].score = ValidatePose(image, database.models()[validated[i].model],
                                      validated[i].T_sensor_object, params.validation);
  });
  validated.erase(std::remove_if(validated.begin(), validated.end(),
                                 [&](const Candidate& candidate) {
                                   return candidate.score < params.validation.min_score;
                                 }),
                  validated.end());
  std::sort(validated.begin(), validated.end(), BetterCandidate);
  return validated;
}

CandidateList RefineCandidates(const RangeImage& image, const CandidateList& candidates,
                               const ModelDatabase& database, const PipelineParams& params,
                               const Execution& execution) {
  const StageScope stage(execution, "refinement");
  const PoseRefinementParams& refinement = params.pose_refinement;
  const Scene scene(image, refinement.normal_radius, execution);
  CandidateList refined = candidates;
  execution.parallel_for(refined.size(), [&](std::size_t i) {
    const ObjectModel& model = database.models()[refined[i].model];
    const int view = NearestView(model, refined[i].T_sensor_object);
    if (view < 0) return;
    const SurfaceSample surface{model.views[view].validation_points,
                                model.views[view].validation_normals};
    refined[i].T_sensor_object =
        RefinePose(scene, surface, refined[i].T_sensor_object.cast<float>(),
                   {refinement.iterations, refinement.first_gate, refinement.last_gate,
                    refinement.damping, refinement.damping})
            .cast<double>();
  });
  return refined;
}

CandidateList WithoutCollisions(const CandidateList& candidates, const ModelDatabase& database,
                                const PipelineParams& params, const Execution& execution) {
  const StageScope stage(execution, "collisions");
  return RejectCollisions(candidates, database.collision_shapes(), params.collisions);
}

}  // namespace

ModelMatches MatchByModel(const FeatureSet& features, const ModelDatabase& database,
                          const PipelineParams& params, const Execution& execution) {
  const StageScope stage(execution, "matching");
  MatchingParams matching = params.matching;
  if (params.descriptor == DescriptorType::kSphericalSpin) {
    matching.min_shared_cells = 0;  // none is ever empty
  }
  ModelMatches by_model(database.models().size());
  for (const Correspondence& match :
       MatchFeatures(features.features, database.descriptors(), matching, execution)) {
    const int model = database.feature(match.model_feature).model;
    by_model[model].push_back(
        {match.scene_feature, match.model_feature - database.first_feature(model), match.distance});
  }
  return by_model;
}

StagedCandidates ProposeByTriples(const RangeImage& image, const FeatureSet& features,
                                  const ModelMatches& matches, const ModelDatabase& database,
                                  const PipelineParams& params, const Execution& execution) {
  const auto poses = GeneratePoses(matches, features, database, params, execution);
  StagedCandidates found;
  found.scored = ScorePoses(image, poses, database, params, execution);
  found.num_found = static_cast<int>(found.scored.size());
  const StageScope stage(execution, "pruning");
  std::sort(found.scored.begin(), found.scored.end(), BetterCandidate);
  found.pruned = PruneToLocalBest(found.scored, database.models(), params.pruning);
  return found;
}

StagedCandidates FindByTriples(const RangeImage& image, const FeatureSet& features,
                               const ModelDatabase& database, const PipelineParams& params,
                               const Execution& execution) {
  const ModelMatches matches = MatchByModel(features, database, params, execution);
  StagedCandidates found = ProposeByTriples(image, features, matches, database, params, execution);
  CandidateList& pruned = found.pruned;
  if (params.pose_refinement.iterations > 0)
    pruned = RefineCandidates(image, pruned, database, params, execution);
  CandidateList &collision_free = found.collision_free, &validated = found.validated;
  if (params.validation.before_collisions) {
    validated = ValidateCandidates(image, pruned, database, params, execution);
    validated = collision_free = WithoutCollisions(validated, database, params, execution);
  } else {
    collision_free = WithoutCollisions(pruned, database, params, execution);
    validated = ValidateCandidates(image, collision_free, database, params, execution);
  }
  return found;
}

}  // namespace rimod
