#pragma once

#include <vector>

#include "rimod/candidates.h"
#include "rimod/features.h"
#include "rimod/matching.h"
#include "rimod/model_database.h"

namespace rimod {

// How many of the scene's features a pose explains.
struct FeatureSupport {
  int inside = 0;    // lie in the object's box
  int matching = 0;  // .. and have a correspondence to the model's feature at that very place
};

// Counts it for many poses. Refers to what it is made from.
class FeatureSupportCounter {
 public:
  FeatureSupportCounter(const FeatureSet& features, const ModelMatches& matches,
                        const ModelDatabase& database);

  FeatureSupport Count(const Candidate& candidate) const;

 private:
  // A scene feature, placed in the object's frame.
  bool HasMatch(int model, int scene_feature, const Feature& on_object) const;

  const FeatureSet& features_;
  const ModelMatches& matches_;
  const ModelDatabase& database_;
};

}  // namespace rimod
