#pragma once

#include <cstddef>
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
  // matches: by scene feature, rising, as MatchFeatures gives them.
  FeatureSupportCounter(const FeatureSet& features, const std::vector<Correspondence>& matches,
                        const ModelDatabase& database);

  FeatureSupport Count(const Candidate& candidate) const;

 private:
  bool Explains(const Correspondence& match, int model, const Feature& on_object) const;

  const FeatureSet& features_;
  const std::vector<Correspondence>& matches_;
  const ModelDatabase& database_;
  std::vector<std::size_t> first_;  // match of each feature; one more: the end
};

}  // namespace rimod
