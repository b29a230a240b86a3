#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "rimod/candidate_choice.h"
#include "rimod/features.h"
#include "rimod/hypothesis_ranking.h"
#include "rimod/image_change.h"
#include "rimod/matching.h"
#include "rimod/model_database.h"
#include "rimod/scene.h"

namespace rimod {

// What the default method's look at a sweep that still goes on leaves to the next one. Where the
// surroundings of a hypothesis have not changed it is settled: what was found out of it stays.

// Correspondences of features that were matched before.
struct KnownMatches {
  FeatureSet features;
  ModelMatches matches;
};

// What became of a hypothesis that was refined.
struct HypothesisHistory {
  Hypothesis proposed;
  std::optional<Hypothesis> ranked;           // refined, when it was judged
  std::optional<ExplainingCandidate> judged;  // then too
};

struct EarlierLook {
  Scene scene;
  KnownMatches known;
  std::vector<HypothesisHistory> histories;  // model after model, best proposed first
};

// For each feature the number of the known one that is the same, -1: none.
std::vector<int> FindKnown(const FeatureSet& features, const FeatureSet& known);

// One model's correspondences of all features: of those that are unknown (known_as -1; numbered by
// themselves) and of those that are known. Both lists in the order of their features.
std::vector<Correspondence> WithKnown(const std::vector<Correspondence>& of_unknown,
                                      const std::vector<Correspondence>& of_known,
                                      const std::vector<int>& known_as);

// Whether anything is new in the pixels that a model at a pose may cover, or within 15 cm around
// it.
bool HasNews(const ImageChange& change, const ObjectModel& model,
             const Eigen::Isometry3f& T_sensor_object);

// Leads the hypotheses of a look through its stages together with those of the look before that are
// settled: of which no pose, from the proposed to the judged one, has news. These take their part
// of the quotas like the fresh ones, and are not worked on again.
class SettledHypotheses {
 public:
  // before: null when there was none. All must outlive this.
  SettledHypotheses(const EarlierLook* before, const ImageChange& change,
                    const ModelDatabase& database);

  // Each: the fresh ones that the quota lets through beside the settled ones. The fresh ones come
  // model after model, best first; ranked ones have the origin of the proposed ones.
  std::vector<Hypothesis> Propose(std::vector<Hypothesis> fresh, const ModelQuota& quota);
  std::vector<Hypothesis> Rank(std::vector<Hypothesis> fresh, const ModelQuota& quota);
  // Adds the settled candidates to those that were found of the fresh ones, given with the origin
  // of each; best first.
  void Judge(const std::vector<int>& origins, JudgedScan* found);

  // For the next look, once all is judged.
  std::vector<HypothesisHistory> TakeHistories() { return std::move(histories_); }

 private:
  std::vector<const HypothesisHistory*> settled_before_;
  const ImageChange& change_;
  std::vector<HypothesisHistory> histories_;              // of this look, by origin
  std::vector<const HypothesisHistory*> history_before_;  // null: fresh; by origin
};

}  // namespace rimod
