#pragma once

#include <vector>

#include "benchmarks/peers/peer.h"
#include "rimod/default_method.h"
#include "rimod/detection.h"
#include "rimod/scan.h"

namespace rimod::peers {

// The end of our own method on poses that others propose: refinement, ranking, judgement, choice.
class Judge {
 public:
  Judge(std::vector<ObjectModel> models, const PipelineParams& params, const Execution& execution);

  // By name; proposals number these.
  const std::vector<ObjectModel>& models() const { return models_; }

  // What judging needs of a scan and what is no part of its time: normals, features, matches.
  struct PreparedScan {
    Scene scene;
    FeatureSet features;
    ModelMatches matches;
  };
  PreparedScan Prepare(const Scan& scan) const;

  std::vector<Detection> Choose(const PreparedScan& scan,
                                const std::vector<Proposal>& proposals) const;

 private:
  std::vector<ObjectModel> models_;
  PipelineParams params_;
  Execution execution_;
  ModelDatabase database_;
};

// Best first, one of those that are at one place; those given up by the library are left out.
std::vector<Detection> BestOfEachPlace(std::vector<Proposal> proposals,
                                       const std::vector<ObjectModel>& models);

}  // namespace rimod::peers
