#pragma once

#include <vector>

#include "rimod/candidates.h"
#include "rimod/evidence.h"
#include "rimod/execution.h"
#include "rimod/feature_support.h"
#include "rimod/features.h"
#include "rimod/hypothesis_ranking.h"
#include "rimod/model_database.h"
#include "rimod/params.h"
#include "rimod/scene.h"

namespace rimod {

// The last step before the choice: candidates are refined with their whole surface, the model is
// rendered, and all the evidence for and against becomes one probability.

// Everything that judging a candidate found.
struct JudgedCandidate {
  Candidate candidate;      // score: probability that it is right
  double rank_score = 0.0;  // the hypothesis's ..
  int origin = -1;          // .. and so is this
  RankingFigures figures;
  FeatureSupport support;
  Evidence evidence;
};

// The ranked candidates refined in all degrees of freedom and judged, best first, ties by model.
// What a first look after a short refinement gives up stays as that saw it, or, where the model
// spans many pixels, a look at every other row and column before it. What leans by less than
// refinement.upright_tilt is judged leaning and upright; it counts as upright unless leaning it is
// min_leaning_odds times as probable: most things stand, but a sensor's own tilt is known to a
// degree at best. Stage validation.
std::vector<JudgedCandidate> JudgeCandidates(const Scene& scene, const FeatureSet& features,
                                             const ModelMatches& matches,
                                             const std::vector<Hypothesis>& ranked,
                                             const ModelDatabase& database,
                                             const PipelineParams& params,
                                             const Execution& execution);

}  // namespace rimod
