#pragma once

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
// surroundings of a pose have not changed it is settled: what was found out of it stays.

// Correspondences of features that were matched before.
struct KnownMatches {
  FeatureSet features;
  ModelMatches matches;
};

struct EarlierLook {
  Scene scene;
  KnownMatches known;
  std::vector<Hypothesis> proposed;  // that were refined, model after model, best first
  std::vector<Hypothesis> ranked;    // that were judged, likewise
  JudgedScan judged;
};

// For each feature the number of the known one that is the same, -1: none.
std::vector<int> FindKnown(const FeatureSet& features, const FeatureSet& known);

// One model's correspondences of all features: of those that are unknown (known_as -1; numbered by
// themselves) and of those that are known. Both lists in the order of their features.
std::vector<Correspondence> WithKnown(const std::vector<Correspondence>& of_unknown,
                                      const std::vector<Correspondence>& of_known,
                                      const std::vector<int>& known_as);

// Whether anything is new that a model at a pose may have to do with: refinement moves it, judging
// looks at what is around.
bool HasNews(const ImageChange& change, const ObjectModel& model,
             const Eigen::Isometry3f& T_sensor_object);

// The best of both, as a quota lets through, model after model, best first; of the earlier ones
// those that are settled.
std::vector<Hypothesis> WithSettled(std::vector<Hypothesis> fresh,
                                    const std::vector<Hypothesis>& earlier,
                                    const ImageChange& change, const ModelDatabase& database,
                                    const ModelQuota& quota);

// Those that are to be worked on.
std::vector<Hypothesis> Unsettled(const std::vector<Hypothesis>& hypotheses);

// Adds the earlier candidates that are settled.
void AddSettled(const JudgedScan& before, const ImageChange& change, const ModelDatabase& database,
                JudgedScan* found);

}  // namespace rimod
