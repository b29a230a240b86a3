#pragma once

#include <optional>
#include <vector>

#include "rimod/candidate_choice.h"
#include "rimod/candidate_judging.h"
#include "rimod/candidates.h"
#include "rimod/earlier_look.h"
#include "rimod/execution.h"
#include "rimod/features.h"
#include "rimod/image_change.h"
#include "rimod/model_database.h"
#include "rimod/params.h"
#include "rimod/scene.h"

namespace rimod {

// The default method: a pose from every correspondence, ranked by the views' points, refined by
// ICP, judged by all the evidence that rendering gives, and a choice in which each measured pixel
// is explained once. Until that choice what is found of a model does not depend on the others.
// docs/algorithm.md leads through it.

// All of it but the choice, which is candidate_choice's: what is found of a model depends on the
// scan and that model.
//
// earlier: of the same sweep, database and parameters; is replaced by this look. What the images
// have in common is taken from there: normals, correspondences, and the hypotheses in whose
// surroundings nothing has changed, with what became of them; they take their part of the quotas.
// Only hypotheses that something new belongs to are scored, refined and judged. The result is about
// what a look without it finds, not the same.
JudgedScan FindByEvidence(const RangeImage& image, const FeatureSet& features,
                          const ModelDatabase& database, const PipelineParams& params,
                          const Execution& execution,
                          std::optional<EarlierLook>* earlier = nullptr);

// Its steps, also for training the judgement.

// Each model's correspondences, the scene's features in order. Features that are known keep theirs.
// Stage matching.
ModelMatches MatchToModels(const FeatureSet& features, const ModelDatabase& database,
                           const PipelineParams& params, const Execution& execution,
                           const KnownMatches* known = nullptr);

// A pose or two from every correspondence, scored as they are, without hopeless ones: of each model
// the best of different poses, by the quota of refinement. Model after model, best first.
// num_found: before any was left out. What has no news in the change is left out, too. Stages
// hypotheses, scoring.
std::vector<Hypothesis> ProposeHypotheses(const Scene& scene, const FeatureSet& features,
                                          const ModelMatches& matches,
                                          const ModelDatabase& database,
                                          const PipelineParams& params, const Execution& execution,
                                          int* num_found, const ImageChange& change = {});

// Hypotheses (model after model) refined and ranked by what the views' points say then: of each
// model the best of different poses, by the quota of judging. Model after model, best first. Stage
// refinement.
std::vector<Hypothesis> RankHypotheses(const Scene& scene, std::vector<Hypothesis> hypotheses,
                                       const ModelDatabase& database, const PipelineParams& params,
                                       const Execution& execution);

// As the choice wants them. num_found: hypotheses before any was left out.
JudgedScan ToJudgedScan(const Scene& scene, const std::vector<JudgedCandidate>& judged,
                        const ModelDatabase& database, int num_found);

// The chosen ones of judged candidates, best first. Stage collisions.
std::vector<Candidate> ChooseCandidates(const Scene& scene,
                                        const std::vector<JudgedCandidate>& judged,
                                        const ModelDatabase& database, const PipelineParams& params,
                                        const Execution& execution);

}  // namespace rimod
