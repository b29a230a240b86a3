#include "rimod/matching.h"

#include <algorithm>
#include <cmath>

#include "rimod/check.h"

namespace rimod {

void MatchingParams::Validate() const {
  CheckWithin("matching max_descriptor_distance", max_descriptor_distance, 1e-4, 10.0);
  CheckWithin("matching projected_dimensions", projected_dimensions, 1, 256);
  CheckWithin("matching max_matches", max_matches, 1, 100'000);
  CheckWithin("matching max_checks", max_checks, 1, 100'000'000);
  CheckWithin("matching min_correspondences", min_correspondences, 0, 10'000'000);
  CheckWithin("matching min_shared_cells", min_shared_cells, 0, 256);
  CheckWithin("matching min_roughness", min_roughness, 0.0, 10.0);
}

double Roughness(const Descriptor& descriptor) {
  double sum = 0.0, sum_sq = 0.0;
  int count = 0;
  for (const std::int16_t value : descriptor) {
    if (value == kEmptyCell) continue;
    sum += value;
    sum_sq += static_cast<double>(value) * value;
    ++count;
  }
  if (count == 0) return 0.0;
  const double mean = sum / count;
  return kDescriptorUnit * std::sqrt(std::max(sum_sq / count - mean * mean, 0.0));
}

std::vector<Correspondence> MatchFeatures(const std::vector<Feature>& scene,
                                          const DescriptorIndex& index,
                                          const MatchingParams& params,
                                          const Execution& execution) {
  params.Validate();
  std::vector<std::vector<DescriptorMatch>> matches(scene.size());
  execution.parallel_for(scene.size(), [&](std::size_t i) {
    matches[i] =
        index.FindNear(scene[i].descriptor, params.max_matches, params.max_descriptor_distance,
                       params.max_checks, params.min_shared_cells);
    if (params.min_roughness <= 0.0) return;
    const double scale = 1.0 / std::max(Roughness(scene[i].descriptor), params.min_roughness);
    for (DescriptorMatch& match : matches[i]) match.distance *= scale;
  });
  std::vector<Correspondence> correspondences;
  for (std::size_t i = 0; i < scene.size(); ++i)
    for (const DescriptorMatch& match : matches[i])
      correspondences.push_back({static_cast<int>(i), match.index, match.distance});
  return correspondences;
}

}  // namespace rimod
