#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scanner_proc/laser_scanner.h"
#include "scanner_proc/scene.h"

namespace rimod::simulation {

// What a sweep shows of one object that has a class.
struct ObjectTruth {
  std::string class_name;
  Eigen::Isometry3d T_scene_object = Eigen::Isometry3d::Identity();  // see ObjectFrameOf
  int num_points = 0;                                                // readings from it
  double visible = 0.0;  // share of what would be seen of it with nothing else in the scene; 0 .. 1
  double distance = 0.0;  // m, level, from where the sweep began
};

// Watches the beams of one sweep and tells what they show of the scene's objects.
class GroundTruth {
 public:
  explicit GroundTruth(const Scene& scene);
  ~GroundTruth();

  void Add(const ScannedLine& line);
  // Of the lines since the last call, in the scene's order of objects; begins anew.
  std::vector<ObjectTruth> Take();

 private:
  struct Watched;
  std::vector<std::unique_ptr<Watched>> objects_;
  double max_range_;
};

// What a named scan shows, as benchmarks label it.
struct ScanTruth {
  std::string scan;
  std::vector<ObjectTruth> objects;
};

// {"scans": [{"scan": .., "objects": [{"class", "pose", "points", "visible", "distance"}]}]}
std::string TruthJson(const std::vector<ScanTruth>& scans);

// The model.json of a recording: class, object_pose, box, symmetry, up.
std::string ModelJson(const SceneObject& object);

}  // namespace rimod::simulation
