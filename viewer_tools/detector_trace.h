#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rimod/default_method.h"
#include "rimod/hit_counting.h"
#include "rimod/model_database.h"
#include "rimod/params.h"

namespace rimod {

// What a detector made of one scan, stage by stage, to tell where an object was lost.

// The candidates that were left after a step; level sensor frame.
struct TracedStage {
  std::string loss;  // what befell an object that had a right candidate before, but has none here
  PoseError tolerance;       // up to which a candidate counts as right
  CandidateList candidates;  // best first
};

struct DetectorTrace {
  FeatureSet features;
  ModelMatches matches;                 // default method only
  std::vector<TracedStage> stages;      // in the order of work
  std::vector<JudgedCandidate> judged;  // default method only, best first
  CandidateList chosen;                 // the detections, best first
};

// Runs the method that params name, default or paper, and keeps what each step left over. The scene
// is that of the image. Throws as DetectObjects() does.
DetectorTrace TraceDetector(const Scene& scene, const ModelDatabase& database,
                            const PipelineParams& params, const Execution& execution);

// How the detector would judge a pose that somebody gives it: refined, ranked and judged like a
// hypothesis with one vote and the median descriptor distance. Nothing when ranking finds it
// hopeless. Default method only.
std::optional<JudgedCandidate> JudgePose(const Scene& scene, const DetectorTrace& trace,
                                         const Candidate& candidate, const ModelDatabase& database,
                                         const PipelineParams& params, const Execution& execution);

}  // namespace rimod
