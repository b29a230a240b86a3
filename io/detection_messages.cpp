#include "io/detection_messages.h"

#include <algorithm>

#include "io/message_codec.h"
#include "io/pose_messages.h"
#include "rimod/object_model.h"

namespace rimod {
namespace {

constexpr int kFixedBytes = 1000;            // fields other than lists, generously
constexpr std::size_t kMaxStageTimes = 200;  // that a message takes
constexpr std::size_t kMaxStageName = 64;

static_assert(static_cast<int>(HypothesisStage::kScored) == pose_hypothesis_t::STAGE_SCORED &&
                  static_cast<int>(HypothesisStage::kPruned) == pose_hypothesis_t::STAGE_PRUNED &&
                  static_cast<int>(HypothesisStage::kNoCollision) ==
                      pose_hypothesis_t::STAGE_COLLISION &&
                  static_cast<int>(HypothesisStage::kValidated) ==
                      pose_hypothesis_t::STAGE_VALIDATED,
              "stages are numbered alike");

bool IsScore(double score) { return score >= 0.0 && score <= 1.0; }

std::vector<stage_time_t> StageTimeMessages(const StageTimes& times) {
  std::vector<stage_time_t> messages;
  for (const auto& [stage, ms] : times) {
    if (messages.size() == kMaxStageTimes) break;
    stage_time_t message = {};
    message.stage = stage.substr(0, kMaxStageName);
    message.ms = ms;
    messages.push_back(std::move(message));
  }
  return messages;
}

}  // namespace

detection_t ToMessage(const Detection& detection) {
  detection_t message = {};
  message.class_name = detection.class_name;
  SetPosition(detection.T_local_object.translation(), message.position);
  SetOrientation(QuaternionOf(detection.T_local_object), message.orientation);
  SetPosition(detection.box_min, message.box_min);
  SetPosition(detection.box_max, message.box_max);
  message.score = detection.score;
  return message;
}

pose_hypotheses_t ToMessage(const std::vector<PoseHypothesis>& hypotheses, int num_found,
                            std::int64_t utime) {
  pose_hypotheses_t message = {};
  message.utime = utime;
  message.num_found = num_found;
  int bytes = kFixedBytes;
  for (const PoseHypothesis& hypothesis : hypotheses) {
    pose_hypothesis_t item = {};
    item.class_name = hypothesis.class_name;
    SetPosition(hypothesis.T_local_object.translation(), item.position);
    SetOrientation(QuaternionOf(hypothesis.T_local_object), item.orientation);
    item.score = static_cast<float>(hypothesis.score);
    item.stage = static_cast<std::int8_t>(hypothesis.stage);
    bytes += item.getEncodedSize();
    if (bytes > kMaxMessageBytes) break;
    message.hypotheses.push_back(std::move(item));
  }
  message.num_hypotheses = static_cast<std::int32_t>(message.hypotheses.size());
  return message;
}

detections_t ToMessage(const StampedDetections& detections) {
  detections_t message = {};
  message.utime = detections.utime;
  SetPosition(detections.T_local_sensor.translation(), message.sensor_position);
  SetOrientation(LevelQuaternionOf(detections.T_local_sensor), message.sensor_orientation);
  message.num_models = detections.num_models;
  message.stage_times = StageTimeMessages(detections.stage_times);
  message.num_stage_times = static_cast<std::int32_t>(message.stage_times.size());
  int bytes = kFixedBytes + message.getEncodedSize();
  for (const Detection& detection : detections.detections) {
    detection_t item = ToMessage(detection);
    bytes += item.getEncodedSize();
    if (bytes > kMaxMessageBytes) break;
    message.detections.push_back(std::move(item));
  }
  message.num_detections = static_cast<std::int32_t>(message.detections.size());
  return message;
}

HypothesesFromMessage FromMessage(const pose_hypotheses_t& message) {
  if (message.num_hypotheses < 0 ||
      message.hypotheses.size() != static_cast<std::size_t>(message.num_hypotheses) ||
      message.num_found < message.num_hypotheses) {
    return {std::nullopt, "a count does not fit its list"};
  }
  std::vector<PoseHypothesis> hypotheses;
  for (const pose_hypothesis_t& item : message.hypotheses) {
    const std::optional<Eigen::Isometry3d> T_local_object =
        PoseFrom(item.position, item.orientation);
    if (!T_local_object) return {std::nullopt, "a pose is not a pose"};
    if (!IsValidModelName(item.class_name)) return {std::nullopt, "a class name is not valid"};
    if (!IsScore(static_cast<double>(item.score)))
      return {std::nullopt, "a score is not within 0 .. 1"};
    if (item.stage < pose_hypothesis_t::STAGE_SCORED ||
        item.stage > pose_hypothesis_t::STAGE_VALIDATED) {
      return {std::nullopt, "a stage is unknown"};
    }
    hypotheses.push_back({item.class_name, *T_local_object, static_cast<double>(item.score),
                          static_cast<HypothesisStage>(item.stage)});
  }
  return {std::move(hypotheses), ""};
}

DetectionFromMessage FromMessage(const detection_t& message) {
  const std::optional<Eigen::Isometry3d> T_local_object =
      PoseFrom(message.position, message.orientation);
  const Eigen::Vector3d box_min(message.box_min[0], message.box_min[1], message.box_min[2]);
  const Eigen::Vector3d box_max(message.box_max[0], message.box_max[1], message.box_max[2]);
  if (!T_local_object) return {std::nullopt, "a pose is not a pose"};
  if (!IsValidModelName(message.class_name)) return {std::nullopt, "a class name is not valid"};
  if (!IsScore(message.score)) return {std::nullopt, "a score is not within 0 .. 1"};
  if (!box_min.allFinite() || !box_max.allFinite() || (box_min.array() > box_max.array()).any()) {
    return {std::nullopt, "a box is not a box"};
  }
  return {Detection{message.class_name, *T_local_object, box_min, box_max, message.score}, ""};
}

DetectionsFromMessage FromMessage(const detections_t& message) {
  if (message.num_detections < 0 || message.num_stage_times < 0 || message.num_models < 0 ||
      message.detections.size() != static_cast<std::size_t>(message.num_detections) ||
      message.stage_times.size() != static_cast<std::size_t>(message.num_stage_times)) {
    return {std::nullopt, "a count does not fit its list"};
  }
  const std::optional<Eigen::Isometry3d> T_local_sensor =
      LevelPoseFrom(message.sensor_position, message.sensor_orientation);
  if (!T_local_sensor) return {std::nullopt, "sensor pose is not a pose"};
  StampedDetections detections;
  detections.utime = message.utime;
  detections.T_local_sensor = *T_local_sensor;
  detections.num_models = message.num_models;
  for (const detection_t& item : message.detections) {
    DetectionFromMessage converted = FromMessage(item);
    if (!converted.detection) return {std::nullopt, std::move(converted.error)};
    detections.detections.push_back(std::move(*converted.detection));
  }
  for (const stage_time_t& item : message.stage_times) {
    detections.stage_times.emplace_back(item.stage, item.ms);
  }
  return {std::move(detections), ""};
}

}  // namespace rimod
