#include "rimod/earlier_look.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "rimod/model_work.h"

namespace rimod {
namespace {

// Appends the correspondences of one scene feature as those of another number; the list has them by
// rising number.
void AppendMatches(const std::vector<Correspondence>& list, int scene_feature, int as,
                   std::vector<Correspondence>* matches) {
  auto match = std::partition_point(list.begin(), list.end(), [&](const Correspondence& m) {
    return m.scene_feature < scene_feature;
  });
  for (; match != list.end() && match->scene_feature == scene_feature; ++match)
    matches->push_back({as, match->model_feature, match->distance});
}

}  // namespace

std::vector<int> FindKnown(const FeatureSet& features, const FeatureSet& known) {
  using Place = std::array<float, 3>;
  const auto place_of = [](const Feature& feature) -> Place {
    return {feature.position.x(), feature.position.y(), feature.position.z()};
  };
  std::map<Place, int> places;
  for (std::size_t i = 0; i < known.features.size(); ++i)
    places.emplace(place_of(known.features[i]), static_cast<int>(i));
  std::vector<int> found(features.features.size(), -1);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Feature& feature = features.features[i];
    const auto at = places.find(place_of(feature));
    if (at == places.end()) continue;
    const Feature& other = known.features[at->second];
    if (feature.normal == other.normal && feature.descriptor == other.descriptor)
      found[i] = at->second;
  }
  return found;
}

std::vector<Correspondence> WithKnown(const std::vector<Correspondence>& of_unknown,
                                      const std::vector<Correspondence>& of_known,
                                      const std::vector<int>& known_as) {
  std::vector<Correspondence> all;
  all.reserve(of_unknown.size() + of_known.size());
  int next_unknown = 0;
  for (int i = 0; i < static_cast<int>(known_as.size()); ++i) {
    if (known_as[i] >= 0) {
      AppendMatches(of_known, known_as[i], i, &all);
    } else {
      AppendMatches(of_unknown, next_unknown++, i, &all);
    }
  }
  return all;
}

bool HasNews(const ImageChange& change, const ObjectModel& model,
             const Eigen::Isometry3f& T_sensor_object) {
  constexpr float kSurroundings = 0.15f;  // m, that refinement moves over and judging looks at
  return change.TouchesBox(T_sensor_object, model.box_min.cast<float>().array() - kSurroundings,
                           model.box_max.cast<float>().array() + kSurroundings);
}

std::vector<Hypothesis> WithSettled(std::vector<Hypothesis> fresh,
                                    const std::vector<Hypothesis>& earlier,
                                    const ImageChange& change, const ModelDatabase& database,
                                    const ModelQuota& quota) {
  for (Hypothesis hypothesis : earlier) {
    if (HasNews(change, database.models()[hypothesis.model], hypothesis.T_sensor_object)) continue;
    hypothesis.settled = true;
    fresh.push_back(hypothesis);
  }
  std::stable_sort(fresh.begin(), fresh.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.model != b.model ? a.model < b.model : a.score > b.score;
  });
  return BestOfEachModel(fresh, quota);
}

std::vector<Hypothesis> Unsettled(const std::vector<Hypothesis>& hypotheses) {
  std::vector<Hypothesis> unsettled;
  std::copy_if(hypotheses.begin(), hypotheses.end(), std::back_inserter(unsettled),
               [](const Hypothesis& hypothesis) { return !hypothesis.settled; });
  return unsettled;
}

void AddSettled(const JudgedScan& before, const ImageChange& change, const ModelDatabase& database,
                JudgedScan* found) {
  if (change.everything()) return;
  for (const ExplainingCandidate& known : before.candidates) {
    const Candidate& candidate = known.candidate;
    if (HasNews(change, database.models()[candidate.model],
                candidate.T_sensor_object.cast<float>()))
      continue;
    found->candidates.push_back({candidate, known.rank_score, change.MovedRuns(known.explained)});
  }
}

}  // namespace rimod
