#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace rimod {

// The last stage that a pose hypothesis passed.
enum class HypothesisStage { kScored, kPruned, kNoCollision, kValidated };

// A pose that an object may have.
struct PoseHypothesis {
  std::string class_name;
  Eigen::Isometry3d T_local_object = Eigen::Isometry3d::Identity();
  double score = 0.0;  // 0 .. 1, of the last stage that it passed
  HypothesisStage stage = HypothesisStage::kScored;
};

// A known object, found.
struct Detection {
  std::string class_name;
  Eigen::Isometry3d T_local_object = Eigen::Isometry3d::Identity();
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();  // m, object frame
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();
  double score = 0.0;  // 0 .. 1
};

struct DetectionResult {
  int num_hypotheses_found = 0;            // more than are listed when there are very many
  std::vector<PoseHypothesis> hypotheses;  // by falling stage, then score; at most max_reported
  std::vector<Detection> detections;       // by falling score
};

}  // namespace rimod
