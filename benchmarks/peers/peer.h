#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "rimod/object_model.h"
#include "rimod/params.h"
#include "rimod/range_image.h"
#include "rimod/scan.h"

namespace rimod::peers {

// A pose that another library proposes for a model.
struct Candidate {
  std::size_t model = 0;
  Eigen::Isometry3d T_scan_model = Eigen::Isometry3d::Identity();
  double score = 0.0;
};

// What a peer is given: a scan, and our range image of it for FitOf.
struct Scene {
  Scan scan;
  RangeImage image;
};

// Milliseconds of wall and processor time.
struct Times {
  double wall_ms = 0.0;
  double cpu_ms = 0.0;
};

// The part of a model that faces the sensor at a pose: indices of its points.
std::vector<int> FacingPoints(const ObjectModel& model, const Eigen::Isometry3d& T_scan_model,
                              const Eigen::Vector3d& sensor);

// How well a pose fits, 0 .. 1: of the model's points that face the sensor and are not hidden,
// those that the scene has at their place, less those that it looked through; poses that show
// little of the model are worth less. Given to all peers, whose own measures are worse at that.
double FitOf(const ObjectModel& model, const Eigen::Isometry3d& T_scan_model, const Scene& scene);

// Leaning by at most 20 degrees, as our own method takes for granted.
bool IsUpright(const Eigen::Isometry3d& T_scan_model);

// Best first, one of those that are at one place; those below min_score are left out.
std::vector<Candidate> BestOfEachPlace(std::vector<Candidate> candidates,
                                       const std::vector<ObjectModel>& models, double min_score);

// The program: `PEER --models DIR [--min-score S] SCAN...`. Gives the models to learn, then each
// scan to find; prints detections as rimod-detect does and times on stderr.
struct Peer {
  std::function<void(const std::vector<ObjectModel>&)> learn;
  std::function<std::vector<Candidate>(const Scene&)> find;
};
int RunPeer(int argc, char** argv, const Peer& peer);

}  // namespace rimod::peers
