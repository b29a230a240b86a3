#include "rimod/matching.h"

#include "rimod/check.h"

namespace rimod {

void MatchingParams::Validate() const {
  CheckWithin("matching max_descriptor_distance", max_descriptor_distance, 1e-4, 10.0);
  CheckWithin("matching max_matches", max_matches, 1, 100'000);
  CheckWithin("matching max_checks", max_checks, 1, 100'000'000);
}

std::vector<Correspondence> MatchFeatures(const std::vector<Feature>& scene,
                                          const DescriptorIndex& index,
                                          const MatchingParams& params,
                                          const Execution& execution) {
  params.Validate();
  std::vector<std::vector<DescriptorMatch>> matches(scene.size());
  execution.parallel_for(scene.size(), [&](std::size_t i) {
    matches[i] = index.FindNear(scene[i].descriptor, params.max_matches,
                                params.max_descriptor_distance, params.max_checks);
  });
  std::vector<Correspondence> correspondences;
  for (std::size_t i = 0; i < scene.size(); ++i)
    for (const DescriptorMatch& match : matches[i])
      correspondences.push_back({static_cast<int>(i), match.index, match.distance});
  return correspondences;
}

}  // namespace rimod
