#pragma once

#include <vector>

#include "rimod/descriptor_index.h"
#include "rimod/execution.h"
#include "rimod/features.h"

namespace rimod {

// A feature of the scene that may be the same as one of a model (paper, section III-A).
struct Correspondence {
  int scene_feature = 0;
  int model_feature = 0;  // in whatever list the index was built from
  double distance = 0.0;  // m, between the descriptors
};

// Each model's correspondences, the scene's features in order.
using ModelMatches = std::vector<std::vector<Correspondence>>;

struct MatchingParams {
  double max_descriptor_distance = 0.03;  // m, root mean square a cell; d_max of the paper; > 0
  // The default method matches with each model on its own, the paper's with all at once.
  int max_matches = 60;  // nearest model features kept for one of the scene; >= 1
  int max_checks = 800;  // model features looked at for one of the scene; >= 1
  // Default method: where a scene has few features each keeps more matches and has more looked at,
  // until a model has about so many correspondences; >= 0
  int min_correspondences = 0;
  // Cells that two descriptors must share: the matches found are compared anew over the cells that
  // both have. 0 .. 256, 0 = empty cells count as lying at the mean.
  int min_shared_cells = 0;
  // m, distances count relative to how rough (standard deviation) the scene's patch is, but at
  // least this: flat patches, which are everywhere, come last. 0 = distances as they are.
  double min_roughness = 0.0;
  // Default method: lowest frequencies that descriptors are shortened to before the search;
  // distances are then root mean squares over these. 1 .. 256
  int projected_dimensions = 16;
  void Validate() const;
};

// Standard deviation of a descriptor's values over the cells that are not empty, m; 0 without any.
double Roughness(const Descriptor& descriptor);

// The correspondences of each scene feature, scene features in order, each with its nearest first.
std::vector<Correspondence> MatchFeatures(const std::vector<Feature>& scene,
                                          const DescriptorIndex& index,
                                          const MatchingParams& params, const Execution& execution);

}  // namespace rimod
