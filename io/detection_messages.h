#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/stage_timer.h"
#include "rimod/detection.h"
#include "rimod/detections_t.hpp"
#include "rimod/pose_hypotheses_t.hpp"

namespace rimod {

// Messages hold as many as fit into kMaxMessageBytes, the best ones.
pose_hypotheses_t ToMessage(const std::vector<PoseHypothesis>& hypotheses, int num_found,
                            std::int64_t utime);

detection_t ToMessage(const Detection& detection);

// What was found in one scan, with what a receiver needs to use it.
struct StampedDetections {
  std::int64_t utime = 0;                                            // us, the scan's
  Eigen::Isometry3d T_local_sensor = Eigen::Isometry3d::Identity();  // level
  int num_models = 0;                                                // that were looked for
  std::vector<Detection> detections;
  StageTimes stage_times;  // of the matcher
};
detections_t ToMessage(const StampedDetections& detections);

struct HypothesesFromMessage {
  std::optional<std::vector<PoseHypothesis>> hypotheses;
  std::string error;  // the cause; empty when there are hypotheses (maybe an empty list)
};
// Poses get through as precisely as quaternions allow. Values that are not finite, quaternions that
// are not unit, unknown stages, scores out of range, class names that are not valid give an error.
HypothesesFromMessage FromMessage(const pose_hypotheses_t& message);

struct DetectionFromMessage {
  std::optional<Detection> detection;
  std::string error;
};
DetectionFromMessage FromMessage(const detection_t& message);

struct DetectionsFromMessage {
  std::optional<StampedDetections> detections;
  std::string error;
};
DetectionsFromMessage FromMessage(const detections_t& message);

}  // namespace rimod
