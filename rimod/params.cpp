#include "rimod/params.h"

#include "rimod/check.h"

namespace rimod {

void PipelineParams::Validate() const {
  sweep.Validate();
  range_image.Validate();
  interest_points.Validate();
  range_patch.Validate();
  model_surface.Validate();
  model_views.Validate();
  matching.Validate();
  goodsac.Validate();
  scoring.Validate();
  pruning.Validate();
  collisions.Validate();
  validation.Validate();
  CheckWithin("max_reported_hypotheses", max_reported_hypotheses, 1, 500);
}

PipelineParams DefaultParams(Method method) {
  PipelineParams params;
  params.method = method;
  return params;
}

}  // namespace rimod
