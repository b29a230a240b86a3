#include "rimod/hit_counting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <tuple>

namespace rimod {
namespace {

constexpr double kDegPerRad = 180.0 / M_PI;

const ObjectShape& ShapeOf(const ObjectShapes& shapes, const std::string& class_name) {
  const auto shape = shapes.find(class_name);
  if (shape == shapes.end()) throw std::invalid_argument("class '" + class_name + "' has no model");
  return shape->second;
}

int NumEquivalentTurns(Symmetry symmetry) {
  return symmetry == Symmetry::kYaw2 ? 2 : symmetry == Symmetry::kYaw4 ? 4 : 1;
}

// Counts one detection after the other, best first.
class Counter {
 public:
  Counter(const std::vector<CountedScan>& scans, const ObjectShapes& shapes,
          const HitParams& params)
      : scans_(scans), shapes_(shapes) {
    for (const auto& [name, shape] : shapes) count_.classes.push_back(name);
    for (const CountedScan& scan : scans) {
      count_.detections.emplace_back(scan.detections.size());
      std::vector<CountedObject>& objects = count_.objects.emplace_back(scan.objects.size());
      for (std::size_t i = 0; i < objects.size(); ++i) {
        objects[i].counts = scan.objects[i].visible >= params.min_visible &&
                            scan.objects[i].num_points >= params.min_points;
        ++(objects[i].counts ? count_.num_counted_objects : count_.num_other_objects);
      }
    }
  }

  HitCount Count() {
    std::vector<std::pair<int, int>> order;
    for (std::size_t s = 0; s < scans_.size(); ++s)
      for (std::size_t d = 0; d < scans_[s].detections.size(); ++d)
        order.emplace_back(static_cast<int>(s), static_cast<int>(d));
    std::stable_sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
      return scans_[a.first].detections[a.second].score >
             scans_[b.first].detections[b.second].score;
    });
    for (const auto& [scan, detection] : order) CountDetection(scan, detection);
    CountMisses();
    return std::move(count_);
  }

 private:
  // The object that a detection lies on; -1: none.
  int ObjectUnder(int scan, const Detection& detection) const {
    const Eigen::Vector3d centre =
        detection.T_local_object * ShapeOf(shapes_, detection.class_name).Centre();
    int best = -1;
    std::tuple<bool, bool, double> best_rank;
    for (std::size_t k = 0; k < scans_[scan].objects.size(); ++k) {
      const LabelledObject& object = scans_[scan].objects[k];
      const ObjectShape& shape = ShapeOf(shapes_, object.class_name);
      const double distance = (object.T_local_object * shape.Centre() - centre).norm();
      if (!(distance <= shape.HitRadius())) continue;
      const bool other_class = object.class_name != detection.class_name;
      const bool taken = !other_class && taken_.count({detection.class_name, scan, k}) > 0;
      const std::tuple<bool, bool, double> rank(other_class, taken, distance);
      if (best >= 0 && !(rank < best_rank)) continue;
      best = static_cast<int>(k);
      best_rank = rank;
    }
    return best;
  }

  void CountDetection(int scan, int index) {
    const Detection& detection = scans_[scan].detections[index];
    CountedDetection& counted = count_.detections[scan][index];
    const std::string& name = detection.class_name;
    counted.object = ObjectUnder(scan, detection);
    if (counted.object < 0) return AddFalseAlarm(name, "", Verdict::kClutter, &counted);
    const LabelledObject& object = scans_[scan].objects[counted.object];
    CountedObject& found = count_.objects[scan][counted.object];
    const bool right_class = object.class_name == name;
    if (right_class && !found.counts) {
      counted.verdict = Verdict::kIgnored;
      ++count_.num_ignored;
      return;
    }
    if (!taken_.insert({name, scan, counted.object}).second) {
      counted.verdict = Verdict::kDuplicate;
      ++count_.duplicates[name];
      ++count_.per_class[name].false_alarms;
      return;
    }
    if (!right_class) return AddFalseAlarm(name, object.class_name, Verdict::kConfusion, &counted);
    counted.verdict = Verdict::kRight;
    ++count_.confusion[{name, name}];
    ++count_.per_class[name].right;
    found.detection = index;
    found.error =
        PoseErrorBetween(detection.T_local_object, object.T_local_object, ShapeOf(shapes_, name));
    count_.num_posed += found.Posed() ? 1 : 0;
  }

  void AddFalseAlarm(const std::string& name, const std::string& on, Verdict verdict,
                     CountedDetection* counted) {
    counted->verdict = verdict;
    ++count_.confusion[{name, on}];
    ++count_.per_class[name].false_alarms;
  }

  void CountMisses() {
    for (std::size_t s = 0; s < scans_.size(); ++s)
      for (std::size_t k = 0; k < scans_[s].objects.size(); ++k)
        if (count_.objects[s][k].counts && !count_.objects[s][k].found())
          ++count_.per_class[scans_[s].objects[k].class_name].missed;
    for (const auto& [name, totals] : count_.per_class) {
      count_.total.right += totals.right;
      count_.total.false_alarms += totals.false_alarms;
      count_.total.missed += totals.missed;
    }
  }

  const std::vector<CountedScan>& scans_;
  const ObjectShapes& shapes_;
  HitCount count_;
  std::set<std::tuple<std::string, int, int>> taken_;  // class, scan, object
};

double Ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

}  // namespace

std::optional<Symmetry> SymmetryFrom(const std::string& name) {
  if (name == "none") return Symmetry::kNone;
  if (name == "yaw2") return Symmetry::kYaw2;
  if (name == "yaw4") return Symmetry::kYaw4;
  if (name == "yaw_continuous") return Symmetry::kYawContinuous;
  return std::nullopt;
}

double ObjectShape::HitRadius() const {
  constexpr double kMinRadius = 0.15;  // m
  constexpr double kShare = 0.25;      // of the diameter
  return std::max(kMinRadius, kShare * Diameter());
}

PoseError PoseErrorBetween(const Eigen::Isometry3d& T_local_a, const Eigen::Isometry3d& T_local_b,
                           const ObjectShape& shape) {
  PoseError error;
  error.distance = (T_local_a * shape.Centre() - T_local_b * shape.Centre()).norm();
  const Eigen::Matrix3d a = T_local_a.linear();
  const Eigen::Matrix3d b = T_local_b.linear();
  if (shape.symmetry == Symmetry::kYawContinuous) {
    error.angle_deg = std::acos(std::clamp(a.col(2).dot(b.col(2)), -1.0, 1.0)) * kDegPerRad;
    return error;
  }
  const int num_turns = NumEquivalentTurns(shape.symmetry);
  error.angle_deg = 180.0;
  for (int k = 0; k < num_turns; ++k) {
    const Eigen::AngleAxisd turn(2.0 * M_PI * k / num_turns, Eigen::Vector3d::UnitZ());
    const Eigen::AngleAxisd between(Eigen::Matrix3d(a.transpose() * b * turn.toRotationMatrix()));
    error.angle_deg = std::min(error.angle_deg, std::abs(between.angle()) * kDegPerRad);
  }
  return error;
}

const char* VerdictText(Verdict verdict) {
  switch (verdict) {
    case Verdict::kRight:
      return "right";
    case Verdict::kConfusion:
      return "taken for another class";
    case Verdict::kClutter:
      return "clutter";
    case Verdict::kDuplicate:
      return "found twice";
    case Verdict::kIgnored:
      break;
  }
  return "ignored";
}

bool CountedObject::Posed() const {
  constexpr double kMaxDistance = 0.10;  // m
  constexpr double kMaxAngleDeg = 15.0;
  return found() && error.distance <= kMaxDistance && error.angle_deg <= kMaxAngleDeg;
}

double Totals::Recall() const { return Ratio(right, right + missed); }

double Totals::Precision() const { return Ratio(right, right + false_alarms); }

double Totals::Zeta() const {
  const double loss = static_cast<double>(missed) * missed + false_alarms;
  if (loss > 0.0) return static_cast<double>(right) * right / loss;
  return right > 0 ? std::numeric_limits<double>::infinity() : 0.0;
}

HitCount CountHits(const std::vector<CountedScan>& scans, const ObjectShapes& shapes,
                   const HitParams& params) {
  return Counter(scans, shapes, params).Count();
}

}  // namespace rimod
