#include "rimod/earlier_look.h"

#include <algorithm>
#include <array>
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

bool HasNews(const HypothesisHistory& history, const ImageChange& change,
             const ModelDatabase& database) {
  const ObjectModel& model = database.models()[history.proposed.model];
  const auto news_at = [&](const Eigen::Isometry3f& T_sensor_object) {
    return HasNews(change, model, T_sensor_object);
  };
  return news_at(history.proposed.T_sensor_object) ||
         (history.ranked && news_at(history.ranked->T_sensor_object)) ||
         (history.judged && news_at(history.judged->candidate.T_sensor_object.cast<float>()));
}

// Model after model, best first.
std::vector<Hypothesis> InOrder(std::vector<Hypothesis> hypotheses) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) {
                     return a.model != b.model ? a.model < b.model : a.score > b.score;
                   });
  return hypotheses;
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
  constexpr float kSurroundings = 0.15f;  // m, that judging looks at
  return change.TouchesBox(T_sensor_object, model.box_min.cast<float>().array() - kSurroundings,
                           model.box_max.cast<float>().array() + kSurroundings);
}

SettledHypotheses::SettledHypotheses(const EarlierLook* before, const ImageChange& change,
                                     const ModelDatabase& database)
    : change_(change) {
  if (!before || change.everything()) return;
  for (const HypothesisHistory& history : before->histories)
    if (!HasNews(history, change, database)) settled_before_.push_back(&history);
}

std::vector<Hypothesis> SettledHypotheses::Propose(std::vector<Hypothesis> fresh,
                                                   const ModelQuota& quota) {
  for (Hypothesis& hypothesis : fresh) hypothesis.origin = -1;
  for (std::size_t i = 0; i < settled_before_.size(); ++i) {
    fresh.push_back(settled_before_[i]->proposed);
    fresh.back().origin = static_cast<int>(i);
  }
  std::vector<Hypothesis> unsettled;
  for (Hypothesis& hypothesis : BestOfEachModel(InOrder(std::move(fresh)), quota)) {
    const bool is_fresh = hypothesis.origin < 0;
    history_before_.push_back(is_fresh ? nullptr : settled_before_[hypothesis.origin]);
    hypothesis.origin = static_cast<int>(histories_.size());
    histories_.push_back({hypothesis, {}, {}});
    if (is_fresh) unsettled.push_back(hypothesis);
  }
  return unsettled;
}

std::vector<Hypothesis> SettledHypotheses::Rank(std::vector<Hypothesis> fresh,
                                                const ModelQuota& quota) {
  for (std::size_t i = 0; i < histories_.size(); ++i) {
    const HypothesisHistory* const before = history_before_[i];
    if (!before || !before->ranked) continue;
    fresh.push_back(*before->ranked);
    fresh.back().origin = static_cast<int>(i);
  }
  std::vector<Hypothesis> unsettled;
  for (const Hypothesis& hypothesis : BestOfEachModel(InOrder(std::move(fresh)), quota)) {
    histories_[hypothesis.origin].ranked = hypothesis;
    if (!history_before_[hypothesis.origin]) unsettled.push_back(hypothesis);
  }
  return unsettled;
}

void SettledHypotheses::Judge(const std::vector<int>& origins, JudgedScan* found) {
  for (std::size_t i = 0; i < origins.size(); ++i)
    histories_[origins[i]].judged = found->candidates[i];
  for (std::size_t i = 0; i < histories_.size(); ++i) {
    const HypothesisHistory* const before = history_before_[i];
    if (!before || !before->judged || !histories_[i].ranked) continue;
    ExplainingCandidate candidate = *before->judged;
    candidate.explained = change_.MovedRuns(candidate.explained);
    histories_[i].judged = candidate;
    found->candidates.push_back(std::move(candidate));
  }
  std::stable_sort(found->candidates.begin(), found->candidates.end(),
                   [](const ExplainingCandidate& a, const ExplainingCandidate& b) {
                     return a.candidate.score > b.candidate.score;
                   });
}

}  // namespace rimod
