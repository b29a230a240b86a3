#pragma once

#include <vector>

#include "rimod/candidates.h"
#include "rimod/execution.h"
#include "rimod/feature_support.h"
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

// Each feature's correspondences. Stage matching.
std::vector<Correspondence> MatchToModels(const FeatureSet& features, const ModelDatabase& database,
                                          const PipelineParams& params, const Execution& execution);

struct Hypothesis {
  int model = 0;  // in the database
  Eigen::Isometry3f T_sensor_object = Eigen::Isometry3f::Identity();
  double score = 0.0;
  RankingFigures figures;
};

// A pose or two from every correspondence, scored as they are, without hopeless ones: the
// max_refined best of different poses, best first. num_found: before any was left out. Stages
// hypotheses, scoring.
std::vector<Hypothesis> ProposeHypotheses(const Scene& scene, const FeatureSet& features,
                                          const std::vector<Correspondence>& matches,
                                          const ModelDatabase& database,
                                          const PipelineParams& params, const Execution& execution,
                                          int* num_found);

// Hypotheses refined and ranked by what the views' points say then: the max_judged best of
// different poses, best first. Stage refinement.
std::vector<Hypothesis> RankHypotheses(const Scene& scene, std::vector<Hypothesis> hypotheses,
                                       const ModelDatabase& database, const PipelineParams& params,
                                       const Execution& execution);

// Everything that judging a candidate found.
struct JudgedCandidate {
  Candidate candidate;  // score: probability that it is right
  RankingFigures figures;
  FeatureSupport support;
  Evidence evidence;
};

// The ranked candidates refined in all degrees of freedom and judged, best first. Stage validation.
std::vector<JudgedCandidate> JudgeCandidates(const Scene& scene, const FeatureSet& features,
                                             const std::vector<Correspondence>& matches,
                                             const std::vector<Hypothesis>& ranked,
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
