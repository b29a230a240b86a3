#include "viewer_tools/case_causes.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "rimod/feature_support.h"
#include "rimod/surface_rendering.h"

namespace rimod {
namespace {

struct Nearest {
  int rank = -1;  // among the candidates of all classes; -1: none of the class
  bool right = false;
  PoseError error;
};

// The best candidate of the object's class that is right, else the nearest one.
Nearest FindNearest(const TracedStage& stage, const Candidate& truth, const ObjectShape& shape) {
  Nearest nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < stage.candidates.size(); ++i) {
    const Candidate& candidate = stage.candidates[i];
    if (candidate.model != truth.model) continue;
    const PoseError error =
        PoseErrorBetween(candidate.T_sensor_object, truth.T_sensor_object, shape);
    const bool right =
        error.distance <= stage.tolerance.distance && error.angle_deg <= stage.tolerance.angle_deg;
    constexpr double kMetresPerDegree = 0.01;  // what weighs the same
    const double far = error.distance + kMetresPerDegree * error.angle_deg;
    if (!right && !(far < least)) continue;
    least = far;
    nearest = {static_cast<int>(i), right, error};
    if (right) break;
  }
  return nearest;
}

Eigen::Vector3d CentreOf(const ModelDatabase& database, const Candidate& candidate) {
  const ObjectModel& model = database.models()[candidate.model];
  return candidate.T_sensor_object * Eigen::Vector3d(0.5 * (model.box_min + model.box_max));
}

// Who took the place of a candidate that was probable enough.
std::string Winner(const DetectorTrace& trace, const Candidate& loser,
                   const ModelDatabase& database) {
  const Candidate* winner = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& chosen : trace.chosen) {
    const double distance = (CentreOf(database, chosen) - CentreOf(database, loser)).norm();
    if (chosen.score < loser.score || !(distance < least)) continue;
    winner = &chosen;
    least = distance;
  }
  if (winner == nullptr) return "nothing better is near";
  return fmt::format("{} with {:.2f}, centre {:.2f} m away, took its place",
                     database.models()[winner->model].name, winner->score, least);
}

// Words on the first stage that has no right candidate.
void FollowStages(const CaseContext& context, const Candidate& truth, const ObjectShape& shape,
                  Explanation* explanation) {
  std::string passed;
  for (const TracedStage& stage : context.trace.stages) {
    const Nearest nearest = FindNearest(stage, truth, shape);
    if (nearest.right) {
      explanation->best = stage.candidates[nearest.rank];
      passed = fmt::format("rank {} of {}, score {:.2f}, {:.0f} cm and {:.0f} degrees off",
                           nearest.rank + 1, stage.candidates.size(), explanation->best->score,
                           100.0 * nearest.error.distance, nearest.error.angle_deg);
      continue;
    }
    explanation->cause = stage.loss;
    explanation->detail = passed.empty() ? "no right candidate" : "last right candidate: " + passed;
    if (nearest.rank >= 0 && !explanation->best) {
      explanation->best = stage.candidates[nearest.rank];
      explanation->detail +=
          fmt::format(", the nearest of its class is {:.0f} cm and {:.0f} degrees off",
                      100.0 * nearest.error.distance, nearest.error.angle_deg);
    }
    if (&stage == &context.trace.stages.back() && explanation->best)
      explanation->detail += "; " + Winner(context.trace, *explanation->best, context.database);
    return;
  }
  explanation->cause = "found when looked for again";
  explanation->detail = passed;
}

// The detection of the object's class that is nearest beside it, within its diameter; -1: none.
int DetectionBeside(const CaseContext& context, const LabelledObject& object,
                    const ObjectShape& shape, PoseError* error) {
  int nearest = -1;
  error->distance = shape.Diameter();
  for (std::size_t i = 0; i < context.scan.detections.size(); ++i) {
    const Detection& detection = context.scan.detections[i];
    if (detection.class_name != object.class_name) continue;
    const PoseError e = PoseErrorBetween(detection.T_local_object, object.T_local_object, shape);
    if (e.distance <= shape.HitRadius() || e.distance >= error->distance) continue;
    *error = e;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

// Share of the pixels that a false alarm matches which lie on a labelled object.
double ShareOn(const CaseContext& context, const std::vector<int>& pixels,
               const LabelledObject& object) {
  constexpr double kOnSurface = 0.06;  // m
  const int model = ModelNumber(context.database, object.class_name);
  if (model < 0 || pixels.empty()) return 0.0;
  const RangeImage& image = context.image;
  const RenderedModel rendered =
      RenderModel(context.database.models()[model],
                  image.T_local_sensor().inverse() * object.T_local_object, image.grid());
  const auto on_object = std::count_if(pixels.begin(), pixels.end(), [&](int pixel) {
    const int row = pixel / image.width();
    const int column = pixel % image.width();
    const int r = row - rendered.first_row;
    const int c = column - rendered.first_column;
    if (r < 0 || r >= rendered.height || c < 0 || c >= rendered.width) return false;
    return rendered.point(r, c) >= 0 &&
           std::abs(rendered.range(r, c) - image.range(row, column)) < kOnSurface;
  });
  return static_cast<double>(on_object) / static_cast<double>(pixels.size());
}

// The judged candidate that became the detection; null when the trace has none.
const JudgedCandidate* FindJudged(const CaseContext& context, const Detection& detection) {
  const int model = ModelNumber(context.database, detection.class_name);
  const Eigen::Isometry3d T_sensor_local = context.image.T_local_sensor().inverse();
  for (const JudgedCandidate& judged : context.trace.judged) {
    constexpr double kSame = 1e-6;
    const Eigen::Matrix4d difference = judged.candidate.T_sensor_object.matrix() -
                                       (T_sensor_local * detection.T_local_object).matrix();
    if (judged.candidate.model == model && difference.cwiseAbs().maxCoeff() < kSame) return &judged;
  }
  return nullptr;
}

std::string EvidenceText(const Evidence& evidence) {
  const auto percent = [&](EvidenceIndex index) { return 100.0 * evidence.values[index]; };
  return fmt::format(
      "of its pixels {:.0f} % match, {:.0f} % nearly, {:.0f} % are seen through, {:.0f} % hidden; "
      "of its silhouette {:.0f} % jumps, {:.0f} % goes on",
      percent(kMatched), percent(kNearlyMatched), percent(kSeenThrough), percent(kOccluded),
      percent(kSilhouetteJump), percent(kSilhouetteContinues));
}

// What is measured along one side of a rendered model, just inside its silhouette.
struct Rim {
  const char* side = "";
  int seen = 0;     // pixels that nothing is in front of
  int through = 0;  // of them, measured farther than the model
};

// The rims of the four sides: the second rendered pixel of each row and column, for the surface's
// discs stand over by about one.
std::array<Rim, 4> RimsOf(const RangeImage& image, const RenderedModel& rendered) {
  constexpr double kTolerance = 0.10;  // m
  std::array<Rim, 4> rims = {{{"left"}, {"right"}, {"upper"}, {"lower"}}};
  // Walks along a line of pixels into the model; at(k) gives the k-th's row and column.
  const auto walk = [&](int length, const auto& at, Rim* rim) {
    int depth = 0;
    for (int k = 0; k < length && depth < 2; ++k) {
      const auto [row, column] = at(k);
      depth = rendered.point(row, column) < 0 ? 0 : depth + 1;
      const int r = row + rendered.first_row;
      const int c = column + rendered.first_column;
      if (depth < 2 || !image.grid().Contains(r, c) || !image.measured(r, c)) continue;
      const double behind = image.range(r, c) - rendered.range(row, column);
      if (behind < -kTolerance) continue;
      ++rim->seen;
      rim->through += behind > kTolerance ? 1 : 0;
    }
  };
  const int w = rendered.width;
  const int h = rendered.height;
  for (int row = 0; row < h; ++row) {
    walk(
        w, [&](int k) { return std::pair(row, k); }, &rims[0]);
    walk(
        w, [&](int k) { return std::pair(row, w - 1 - k); }, &rims[1]);
  }
  for (int column = 0; column < w; ++column) {
    walk(
        h, [&](int k) { return std::pair(k, column); }, &rims[2]);
    walk(
        h, [&](int k) { return std::pair(h - 1 - k, column); }, &rims[3]);
  }
  return rims;
}

// The sides of a false alarm that the laser went past, when there are two: what stands there is
// smaller. Of the right detections on the training scans one in twenty has two such sides.
std::string SidesSeenThrough(const CaseContext& context, const Candidate& candidate) {
  const std::array<Rim, 4> rims =
      RimsOf(context.image, RenderModel(context.database.models()[candidate.model],
                                        candidate.T_sensor_object, context.image.grid()));
  std::string sides;
  int num_sides = 0;
  for (const Rim& rim : rims) {
    constexpr int kMinPixels = 5;
    constexpr double kMuch = 0.4;
    if (rim.seen < kMinPixels || rim.through < kMuch * rim.seen) continue;
    sides += fmt::format("{}{} ({} of {} pixels)", sides.empty() ? "" : ", ", rim.side, rim.through,
                         rim.seen);
    ++num_sides;
  }
  return num_sides >= 2 ? sides : "";
}

Explanation ExplainClutter(const CaseContext& context, const Detection& detection) {
  const JudgedCandidate* judged = FindJudged(context, detection);
  if (judged == nullptr) return {"clutter", "not among the candidates when looked for again", {}};
  const Evidence& evidence = judged->evidence;
  for (const LabelledObject& object : context.scan.objects) {
    constexpr double kMostly = 0.5;
    const double share = ShareOn(context, evidence.explained, object);
    if (share < kMostly) continue;
    return {"a part of another object",
            fmt::format("{:.0f} % of what it matches lies on the {}; {}", 100.0 * share,
                        object.class_name, EvidenceText(evidence)),
            {}};
  }
  const std::string sides = SidesSeenThrough(context, judged->candidate);
  if (!sides.empty())
    return {"something smaller",
            "seen through along its sides: " + sides + "; " + EvidenceText(evidence),
            {}};
  constexpr double kFlatRelief = 0.15;  // of the matched pixels lie off one plane
  const bool flat = evidence.values[kRelief] < kFlatRelief;
  return {flat ? "clutter that is flat" : "clutter", EvidenceText(evidence), {}};
}

}  // namespace

int ModelNumber(const ModelDatabase& database, const std::string& class_name) {
  for (std::size_t i = 0; i < database.models().size(); ++i)
    if (database.models()[i].name == class_name) return static_cast<int>(i);
  return -1;
}

Explanation ExplainMiss(const CaseContext& context, int object_index) {
  const LabelledObject& object = context.scan.objects[object_index];
  const ObjectShape& shape = context.shapes.at(object.class_name);
  const Candidate truth{ModelNumber(context.database, object.class_name),
                        context.image.T_local_sensor().inverse() * object.T_local_object, 0.0};
  Explanation explanation;
  if (truth.model < 0) return {"not looked for", "there is no model of its class", {}};
  FollowStages(context, truth, shape, &explanation);
  PoseError beside;
  if (DetectionBeside(context, object, shape, &beside) >= 0) {
    explanation.detail = fmt::format(
        "found {:.0f} cm and {:.0f} degrees off; the right pose: {}, {}", 100.0 * beside.distance,
        beside.angle_deg, explanation.cause, explanation.detail);
    explanation.cause = "found, but too far off";
  }
  if (context.params.method == Method::kDefault) {
    const FeatureSupport support =
        FeatureSupportCounter(context.trace.features, context.trace.matches, context.database)
            .Count(truth);
    explanation.detail += fmt::format("; {} features in its box, {} with a counterpart",
                                      support.inside, support.matching);
  }
  return explanation;
}

Explanation ExplainFalseAlarm(const CaseContext& context, int detection_index,
                              const CountedDetection& counted) {
  const Detection& detection = context.scan.detections[detection_index];
  if (counted.verdict == Verdict::kDuplicate)
    return {"found twice", "a better one of its class lies on the same object", {}};
  if (counted.verdict == Verdict::kConfusion) {
    const std::string& truth = context.scan.objects[counted.object].class_name;
    const JudgedCandidate* judged = FindJudged(context, detection);
    return {"takes a " + truth + " for a " + detection.class_name,
            judged == nullptr ? "" : EvidenceText(judged->evidence),
            {}};
  }
  const ObjectShape& shape = context.shapes.at(detection.class_name);
  for (const LabelledObject& object : context.scan.objects) {
    if (object.class_name != detection.class_name) continue;
    const PoseError error =
        PoseErrorBetween(detection.T_local_object, object.T_local_object, shape);
    if (error.distance >= shape.Diameter()) continue;
    return {
        "the right object, but too far off",
        fmt::format("{:.0f} cm and {:.0f} degrees off", 100.0 * error.distance, error.angle_deg),
        {}};
  }
  return ExplainClutter(context, detection);
}

}  // namespace rimod
