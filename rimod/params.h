#pragma once

#include "rimod/false_positive_rejection.h"
#include "rimod/goodsac.h"
#include "rimod/interest_points.h"
#include "rimod/matching.h"
#include "rimod/model_surface.h"
#include "rimod/model_views.h"
#include "rimod/range_image.h"
#include "rimod/range_patch.h"
#include "rimod/scoring.h"
#include "rimod/sweep_assembler.h"

namespace rimod {

enum class Method {
  kPaper,    // as literal as it works
  kDefault,  // the best that we know
};

// Everything that can be set, one struct a stage. io/config reads it from YAML.
struct PipelineParams {
  Method method = Method::kDefault;
  SweepParams sweep;
  RangeImageParams range_image;
  InterestPointParams interest_points;
  RangePatchParams range_patch;
  ModelSurfaceParams model_surface;
  ModelViewParams model_views;
  MatchingParams matching;
  GoodsacParams goodsac;
  ScoringParams scoring;
  PruningParams pruning;
  CollisionParams collisions;
  ValidationParams validation;
  int max_reported_hypotheses = 200;  // in a result and its message; 1 .. 500
  void Validate() const;              // all of the above
};

// The parameters that a method starts from.
PipelineParams DefaultParams(Method method);

}  // namespace rimod
