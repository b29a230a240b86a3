#pragma once

#include <vector>

#include "rimod/hypothesis_ranking.h"
#include "rimod/params.h"

namespace rimod {

// How much work the default method puts into each of the models (docs/algorithm.md).

// The parameters for so many models (of the database; ranking.num_models, where it is set, counts
// instead): with more than full_models of them each gets less work. Never less than one of
// anything.
PipelineParams SharedAmongModels(const PipelineParams& params, int num_models);

// Matches and checks for a scene of so many features: more of each where they are few.
MatchingParams ForFeatures(MatchingParams params, int num_features);

// Of hypotheses that come model after model, best first, those that the quota lets go on.
std::vector<Hypothesis> BestOfEachModel(const std::vector<Hypothesis>& hypotheses,
                                        const ModelQuota& quota);

}  // namespace rimod
