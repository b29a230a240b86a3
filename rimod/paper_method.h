#pragma once

#include "rimod/candidates.h"
#include "rimod/execution.h"
#include "rimod/features.h"
#include "rimod/matching.h"
#include "rimod/model_database.h"
#include "rimod/params.h"
#include "rimod/range_image.h"

namespace rimod {

// Section III-A's last step: the correspondences of the scene's features with each model's, which
// count from the model's first one. Stage matching.
ModelMatches MatchByModel(const FeatureSet& features, const ModelDatabase& database,
                          const PipelineParams& params, const Execution& execution);

// Sections III-B and III-C and the local best of III-D; nothing is rejected as false: `scored` and
// `pruned` alone are set.
StagedCandidates ProposeByTriples(const RangeImage& image, const FeatureSet& features,
                                  const ModelMatches& matches, const ModelDatabase& database,
                                  const PipelineParams& params, const Execution& execution);

// The paper's method: triples of correspondences in GOODSAC's order (section III-B), scored by the
// validation points of the nearest view (III-C), false positives rejected (III-D).
StagedCandidates FindByTriples(const RangeImage& image, const FeatureSet& features,
                               const ModelDatabase& database, const PipelineParams& params,
                               const Execution& execution);

}  // namespace rimod
