#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rimod/detection.h"

namespace rimod {

// Counting of detections against labels, as the paper's confusion table wants it (section V). The
// rules: a detection lies on an object when the centres of their boxes are within max(0.15 m,
// 0.25 * the object's diameter); one of its own class is preferred, then the nearest. Best scores
// come first; the first of a class on an object counts, further ones are duplicates.

// Turns about its z-axis that leave an object as it is.
enum class Symmetry { kNone, kYaw2, kYaw4, kYawContinuous };

// "none", "yaw2", "yaw4", "yaw_continuous", as a recording's model.json has it; nothing for others.
std::optional<Symmetry> SymmetryFrom(const std::string& name);

struct ObjectShape {
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();  // m, object frame
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();
  Symmetry symmetry = Symmetry::kNone;

  Eigen::Vector3d Centre() const { return 0.5 * (box_min + box_max); }
  double Diameter() const { return (box_max - box_min).norm(); }
  // How far the centre of a detection on it may be off, m.
  double HitRadius() const;
};

// By class name.
using ObjectShapes = std::map<std::string, ObjectShape>;

// An object that truly stands in a scan.
struct LabelledObject {
  std::string class_name;
  Eigen::Isometry3d T_local_object = Eigen::Isometry3d::Identity();
  int num_points = 1'000'000'000;  // returns from it; where the labels do not tell: enough
  double visible = 1.0;            // share of what would be seen with nothing else in the room
  double distance = 0.0;           // m
};

// How far two poses of an object are apart.
struct PoseError {
  double distance = 0.0;   // m, between the boxes' centres
  double angle_deg = 0.0;  // 0 .. 180, modulo the object's symmetry
};
PoseError PoseErrorBetween(const Eigen::Isometry3d& T_local_a, const Eigen::Isometry3d& T_local_b,
                           const ObjectShape& shape);

// A scan with what is in it and what was found.
struct CountedScan {
  std::vector<LabelledObject> objects;
  std::vector<Detection> detections;
};

struct HitParams {
  double min_visible = 0.2;  // objects less visible or ..
  int min_points = 150;      // .. with fewer points are neither missed nor found
};

enum class Verdict { kRight, kConfusion, kClutter, kDuplicate, kIgnored };
// "right", "taken for another class", "clutter", "found twice", "ignored".
const char* VerdictText(Verdict verdict);

struct CountedDetection {
  Verdict verdict = Verdict::kClutter;
  int object = -1;  // of the scan, that it lies on; -1: none
};

struct CountedObject {
  bool counts = true;  // visible enough
  int detection = -1;  // of the scan, that found it; -1: missed
  PoseError error;     // of that one
  bool found() const { return detection >= 0; }
  // Found within 10 cm and 15 degrees.
  bool Posed() const;
};

struct Totals {
  int right = 0, false_alarms = 0, missed = 0;
  double Recall() const;  // 0 without objects
  double Precision() const;
  // right^2 / (missed^2 + false_alarms), the paper's zeta; infinite for a perfect run.
  double Zeta() const;
};

struct HitCount {
  std::vector<std::vector<CountedDetection>> detections;  // by scan, as they were given
  std::vector<std::vector<CountedObject>> objects;        // by scan, as they were given
  std::vector<std::string> classes;                       // sorted
  // Detections of the first class on objects of the second; the empty second class is clutter.
  std::map<std::pair<std::string, std::string>, int> confusion;
  std::map<std::string, int> duplicates;  // by class
  std::map<std::string, Totals> per_class;
  Totals total;
  int num_counted_objects = 0, num_other_objects = 0, num_ignored = 0, num_posed = 0;
};

// Classes of labels and detections must all have a shape; throws std::invalid_argument naming the
// class otherwise.
HitCount CountHits(const std::vector<CountedScan>& scans, const ObjectShapes& shapes,
                   const HitParams& params);

}  // namespace rimod
