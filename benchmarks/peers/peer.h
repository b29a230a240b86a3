#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "rimod/execution.h"
#include "rimod/object_model.h"

namespace CLI {
class App;
}

namespace rimod::peers {

// A pose that another library proposes for a model.
struct Proposal {
  std::size_t model = 0;
  Eigen::Isometry3d T_scan_model = Eigen::Isometry3d::Identity();
  double measure = 0.0;  // the library's own, greater is better; below 0: it gave the pose up
};

// What a peer is given of a scan, in its frame.
struct ObjectPoints {
  // m: without the floor, what is higher than objects reach and columns that go on above.
  std::vector<Eigen::Vector3f> points;
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  // m, the sensor
};

// Another library; the program around it is RunPeer.
class Peer {
 public:
  virtual ~Peer() = default;
  // Its settings, with what they are called on the command line.
  virtual void AddOptions(CLI::App* app) = 0;
  // models outlive the peer; execution runs loops on num_threads threads.
  virtual void Learn(const std::vector<ObjectModel>& models, int num_threads,
                     const Execution& execution) = 0;
  virtual std::vector<Proposal> Find(const ObjectPoints& scan) = 0;
};

// The part of a model that faces the sensor at a pose: indices of its points.
std::vector<int> FacingPoints(const ObjectModel& model, const Eigen::Isometry3d& T_scan_model,
                              const Eigen::Vector3d& eye);

// Of what faces an eye in the object frame, that which no nearer part of the model hides.
std::vector<int> VisiblePoints(const ObjectModel& model, const Eigen::Vector3d& eye_model);

// Leaning by at most 20 degrees: both our method and the peers are told that objects stand.
bool IsUpright(const Eigen::Isometry3d& T_scan_model);

// T with its rotation made orthonormal; identity where T is not finite.
Eigen::Isometry3d PoseOf(const Eigen::Matrix4d& T);

// The program: `PEER --models DIR [settings] SCAN...`. Gives the models to learn, then each scan to
// find; prints detections as rimod-detect does and times on stderr.
int RunPeer(int argc, char** argv, Peer* peer);

}  // namespace rimod::peers
