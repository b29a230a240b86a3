#pragma once

#include "rimod/candidates.h"
#include "rimod/execution.h"
#include "rimod/features.h"
#include "rimod/model_database.h"
#include "rimod/params.h"
#include "rimod/range_image.h"

namespace rimod {

// The paper's method: triples of correspondences in GOODSAC's order (section III-B), scored by the
// validation points of the nearest view (III-C), false positives rejected (III-D).
StagedCandidates FindByTriples(const RangeImage& image, const FeatureSet& features,
                               const ModelDatabase& database, const PipelineParams& params,
                               const Execution& execution);

}  // namespace rimod
