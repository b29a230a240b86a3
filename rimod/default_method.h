#pragma once

#include <vector>

#include "rimod/candidates.h"
#include "rimod/execution.h"
#include "rimod/features.h"
#include "rimod/model_database.h"
#include "rimod/params.h"
#include "rimod/scene.h"

namespace rimod {

// The default method: a pose from every correspondence, ranked by the views' points, refined by
// ICP, judged by all the evidence that rendering gives, and a choice in which each measured pixel
// is explained once. docs/algorithm.md leads through it.

StagedCandidates FindByEvidence(const RangeImage& image, const FeatureSet& features,
                                const ModelDatabase& database, const PipelineParams& params,
                                const Execution& execution);

// Its steps, also for training the judgement.

// Everything that judging a candidate found.
struct JudgedCandidate {
  Candidate candidate;  // score: probability that it is right
  RankingFigures figures;
  Evidence evidence;
};

// Candidates refined by the views' points, best first by rank, thinned to different poses; the
// first max_judged of them. Stages matching, hypotheses, scoring, refinement.
struct RankedCandidate {
  Candidate candidate;  // score: of the ranking
  RankingFigures figures;
};
std::vector<RankedCandidate> RankCandidates(const Scene& scene, const FeatureSet& features,
                                            const ModelDatabase& database,
                                            const PipelineParams& params,
                                            const Execution& execution, int* num_found);

// The ranked candidates refined in all degrees of freedom and judged, best first. Stage validation.
std::vector<JudgedCandidate> JudgeCandidates(const Scene& scene,
                                             const std::vector<RankedCandidate>& ranked,
                                             const ModelDatabase& database,
                                             const PipelineParams& params,
                                             const Execution& execution);

// Best first, those that are probable enough and mostly explain pixels that no better one explains.
// Stage collisions.
std::vector<Candidate> ChooseCandidates(const Scene& scene,
                                        const std::vector<JudgedCandidate>& judged,
                                        const ModelDatabase& database, const PipelineParams& params,
                                        const Execution& execution);

}  // namespace rimod
