#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "rimod/candidates.h"
#include "rimod/detection.h"
#include "rimod/object_model.h"
#include "rimod/params.h"

namespace rimod {

// The end of the default method, the only part that looks at candidates of several models: which of
// all that were judged in a scan are detections. It needs no models, so that matchers that share
// the models among them can each judge theirs and one process chooses; the result does not depend
// on who judged what.

// What choosing needs of a model.
struct CandidateModel {
  std::string name;
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();  // m, object frame
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();

  double Diameter() const { return (box_max - box_min).norm(); }
  Eigen::Vector3d Centre() const { return 0.5 * (box_min + box_max); }
};

std::vector<CandidateModel> CandidateModelsOf(const std::vector<ObjectModel>& models);

// The runs of pixels that are given by rising index.
std::vector<PixelRun> RunsOf(const std::vector<int>& pixels);

// A judged pose with the pixels that it explains.
struct ExplainingCandidate {
  Candidate candidate;      // model: in the scan's list; score: probability that it is right
  double rank_score = 0.0;  // before it was judged: decides between equal scores
  std::vector<PixelRun> explained;  // rising, apart
};

// What was found in a scan before anything was chosen.
struct JudgedScan {
  int num_pixels = 0;  // of its range image
  Eigen::Isometry3d T_local_sensor = Eigen::Isometry3d::Identity();
  int num_found = 0;                            // poses that were worth a score
  std::vector<CandidateModel> models;           // that were looked for; no two of one name
  std::vector<ExplainingCandidate> candidates;  // those of one model in an order of its own
};

// One list of what parts found in the same scan that each looked for some models. Of a model that
// several looked for only the first one's candidates count; num_found leaves out parts of which
// nothing counts.
JudgedScan Joined(const std::vector<JudgedScan>& parts);

// Leaves out what has no part in ChooseDetections(Joined({judged, ..})), whatever the others are:
// improbable candidates beyond those that can be reported, and their pixels.
JudgedScan WorthJoining(JudgedScan judged, const PipelineParams& params);

// All candidates best first (scored; ties by rank_score, model name, position) and the chosen ones
// (validated): those that are probable enough, mostly explain pixels that no better one explains,
// and keep their distance from better ones.
StagedCandidates ChooseCandidates(const JudgedScan& judged, const ChoiceParams& params);

// Candidates as detections and hypotheses, those of a later stage first, each listed once with the
// last stage that it passed; at most max_reported hypotheses.
DetectionResult ToResult(const StagedCandidates& found, const std::vector<CandidateModel>& models,
                         const Eigen::Isometry3d& T_local_sensor, int max_reported);

// Both together.
DetectionResult ChooseDetections(const JudgedScan& judged, const PipelineParams& params);

}  // namespace rimod
