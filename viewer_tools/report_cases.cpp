#include "viewer_tools/report_cases.h"

#include <spdlog/fmt/fmt.h>

#include <limits>

#include "viewer_tools/case_causes.h"
#include "viewer_tools/detector_trace.h"

namespace rimod {
namespace {

constexpr int kLabelColour = 1;      // of ObjectColour: green
constexpr int kCandidateColour = 0;  // orange
constexpr int kWinnerColour = 2;     // magenta

// Collects the cases of one scan.
class Finder {
 public:
  Finder(const std::string& scan_name, const Scene& scene, const CaseContext& context,
         const Execution& execution)
      : scan_name_(scan_name), scene_(scene), context_(context), execution_(execution) {}

  void AddMiss(int index) {
    const LabelledObject& object = context_.scan.objects[index];
    FoundCase& found = Begin(CaseKind::kMiss, object.class_name);
    const Explanation explanation = ExplainMiss(context_, index);
    SetObject(object, &found);
    found.words.cause = explanation.cause;
    found.words.detail = explanation.detail + JudgeLabel(object, &found.score_at_label);
    AddLabel(object, &found);
    if (explanation.best) AddCandidate(*explanation.best, object, &found);
    AddWinner(object, &found);
  }

  void AddFalseAlarm(int index, const CountedDetection& counted) {
    const Detection& detection = context_.scan.detections[index];
    FoundCase& found = Begin(CaseKind::kFalseAlarm, detection.class_name);
    const Explanation explanation = ExplainFalseAlarm(context_, index, counted);
    found.score = detection.score;
    found.words.cause = explanation.cause;
    found.words.detail = explanation.detail;
    found.words.facts =
        fmt::format("Score {:.2f}, {:.1f} m away", detection.score, DistanceOf(detection));
    AddDetection(detection, &found);
    if (const LabelledObject* const object = NearestObject(detection)) AddLabel(*object, &found);
  }

  void AddPoseOff(int index, const CountedObject& counted) {
    const LabelledObject& object = context_.scan.objects[index];
    const Detection& detection = context_.scan.detections[counted.detection];
    FoundCase& found = Begin(CaseKind::kPoseOff, object.class_name);
    SetObject(object, &found);
    found.score = detection.score;
    constexpr double kFarTurnDeg = 15.0;
    found.words.cause = counted.error.angle_deg > kFarTurnDeg ? "turned" : "shifted";
    found.words.detail =
        fmt::format("score {:.2f}, {:.0f} cm and {:.0f} degrees off", detection.score,
                    100.0 * counted.error.distance, counted.error.angle_deg) +
        JudgeLabel(object, &found.score_at_label);
    AddLabel(object, &found);
    AddDetection(detection, &found);
  }

  std::vector<FoundCase> Take() { return std::move(cases_); }

 private:
  FoundCase& Begin(CaseKind kind, const std::string& class_name) {
    FoundCase& found = cases_.emplace_back();
    found.words.kind = kind;
    found.words.scan = scan_name_;
    found.words.class_name = class_name;
    return found;
  }

  static void SetObject(const LabelledObject& object, FoundCase* found) {
    found->object = object;
    found->words.facts = fmt::format("Visible {:.0f} %, {} points, {:.1f} m away",
                                     100.0 * object.visible, object.num_points, object.distance);
  }

  double DistanceOf(const Detection& detection) const {
    const Eigen::Vector3d centre = 0.5 * (detection.box_min + detection.box_max);
    return (detection.T_local_object * centre - context_.image.T_local_sensor().translation())
        .norm();
  }

  void AddPose(const std::string& title, int model, const Eigen::Isometry3d& T_local_object,
               int colour, FoundCase* found) const {
    if (model < 0) return;
    found->poses.push_back(
        {title, &context_.database.models()[model], T_local_object, ObjectColour(colour)});
  }

  void AddLabel(const LabelledObject& object, FoundCase* found) const {
    AddPose("label", ModelNumber(context_.database, object.class_name), object.T_local_object,
            kLabelColour, found);
  }

  // Candidates that are far from the object would only make the picture small.
  void AddCandidate(const Candidate& candidate, const LabelledObject& object,
                    FoundCase* found) const {
    const ObjectShape& shape = context_.shapes.at(object.class_name);
    const Eigen::Isometry3d pose = context_.image.T_local_sensor() * candidate.T_sensor_object;
    if (PoseErrorBetween(pose, object.T_local_object, shape).distance > 0.5 * shape.Diameter())
      return;
    AddPose(fmt::format("candidate, score {:.2f}", candidate.score), candidate.model, pose,
            kCandidateColour, found);
  }

  void AddDetection(const Detection& detection, FoundCase* found) const {
    AddPose(fmt::format("detection, score {:.2f}", detection.score),
            ModelNumber(context_.database, detection.class_name), detection.T_local_object,
            kCandidateColour, found);
  }

  // The detection that stands where the object is.
  void AddWinner(const LabelledObject& object, FoundCase* found) const {
    const ObjectShape& shape = context_.shapes.at(object.class_name);
    const Eigen::Vector3d centre = object.T_local_object * shape.Centre();
    for (const Detection& detection : context_.scan.detections) {
      const ObjectShape& other = context_.shapes.at(detection.class_name);
      if ((detection.T_local_object * other.Centre() - centre).norm() > 0.5 * shape.Diameter())
        continue;
      AddPose(fmt::format("detection, score {:.2f}", detection.score),
              ModelNumber(context_.database, detection.class_name), detection.T_local_object,
              kWinnerColour, found);
      return;
    }
  }

  // The labelled object nearest to a detection, if they may touch.
  const LabelledObject* NearestObject(const Detection& detection) const {
    const LabelledObject* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    const ObjectShape& own = context_.shapes.at(detection.class_name);
    const Eigen::Vector3d centre = detection.T_local_object * own.Centre();
    for (const LabelledObject& object : context_.scan.objects) {
      const ObjectShape& shape = context_.shapes.at(object.class_name);
      const double distance = (object.T_local_object * shape.Centre() - centre).norm();
      if (!(distance < least) || distance > 0.5 * (own.Diameter() + shape.Diameter())) continue;
      least = distance;
      nearest = &object;
    }
    return nearest;
  }

  // What the detector would have thought of the label.
  std::string JudgeLabel(const LabelledObject& object, std::optional<double>* score) const {
    const int model = ModelNumber(context_.database, object.class_name);
    if (context_.params.method != Method::kDefault || model < 0) return "";
    const Eigen::Isometry3d T_sensor_local = context_.image.T_local_sensor().inverse();
    const std::optional<JudgedCandidate> judged =
        JudgePose(scene_, context_.trace, {model, T_sensor_local * object.T_local_object, 0.0},
                  context_.database, context_.params, execution_);
    if (!judged) return "; a hypothesis started at the label would be hopeless";
    *score = judged->candidate.score;
    const PoseError error =
        PoseErrorBetween(context_.image.T_local_sensor() * judged->candidate.T_sensor_object,
                         object.T_local_object, context_.shapes.at(object.class_name));
    return fmt::format(
        "; a hypothesis started at the label gets {:.2f}, {:.0f} cm and {:.0f} "
        "degrees off ({:.0f} % match, {:.0f} % seen through, {:.0f} % hidden)",
        judged->candidate.score, 100.0 * error.distance, error.angle_deg,
        100.0 * judged->evidence.values[kMatched], 100.0 * judged->evidence.values[kSeenThrough],
        100.0 * judged->evidence.values[kOccluded]);
  }

  const std::string& scan_name_;
  const Scene& scene_;
  const CaseContext& context_;
  const Execution& execution_;
  std::vector<FoundCase> cases_;
};

bool IsFalse(Verdict verdict) { return verdict != Verdict::kRight && verdict != Verdict::kIgnored; }

bool AllWell(const HitCount& counted) {
  return counted.total.missed == 0 && counted.total.false_alarms == 0 &&
         counted.num_posed == counted.total.right;
}

}  // namespace

std::vector<FoundCase> FindCases(const std::string& scan_name, const RangeImage& image,
                                 const CountedScan& scan, const HitCount& counted,
                                 const ModelDatabase& database, const ObjectShapes& shapes,
                                 const PipelineParams& params, const Execution& execution) {
  if (AllWell(counted)) return {};
  const Scene scene(image, params.evidence.normal_radius, execution);
  const DetectorTrace trace = TraceDetector(scene, database, params, execution);
  const CaseContext context{image, scan, trace, database, shapes, params};
  Finder finder(scan_name, scene, context, execution);
  for (std::size_t i = 0; i < scan.objects.size(); ++i) {
    const CountedObject& object = counted.objects[0][i];
    if (!object.counts) continue;
    if (!object.found()) finder.AddMiss(static_cast<int>(i));
    if (object.found() && !object.Posed()) finder.AddPoseOff(static_cast<int>(i), object);
  }
  for (std::size_t i = 0; i < scan.detections.size(); ++i)
    if (IsFalse(counted.detections[0][i].verdict))
      finder.AddFalseAlarm(static_cast<int>(i), counted.detections[0][i]);
  return finder.Take();
}

}  // namespace rimod
