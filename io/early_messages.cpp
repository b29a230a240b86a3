#include "io/early_messages.h"

#include <utility>

#include "io/detection_messages.h"
#include "io/message_codec.h"
#include "io/pose_messages.h"

namespace rimod {
namespace {

static_assert(static_cast<int>(EarlyStatus::kNew) == early_detection_t::STATUS_NEW &&
                  static_cast<int>(EarlyStatus::kConfirmed) ==
                      early_detection_t::STATUS_CONFIRMED &&
                  static_cast<int>(EarlyStatus::kUnseen) == early_detection_t::STATUS_UNSEEN &&
                  static_cast<int>(EarlyStatus::kWithdrawn) == early_detection_t::STATUS_WITHDRAWN,
              "states are numbered alike");

early_detection_t ToMessage(const EarlyObject& object) {
  early_detection_t message = {};
  message.id = object.id;
  message.status = static_cast<std::int8_t>(object.status);
  message.first_utime = object.first_told.count();
  message.unseen_share = object.unseen_share;
  message.detection = ToMessage(object.detection);
  return message;
}

}  // namespace

early_detections_t ToMessage(const StampedEarlyObjects& early) {
  early_detections_t message = {};
  message.utime = early.utime;
  message.utime_end = early.known_until;
  message.is_final = early.is_final ? 1 : 0;
  SetPosition(early.T_local_sensor.translation(), message.sensor_position);
  SetOrientation(LevelQuaternionOf(early.T_local_sensor), message.sensor_orientation);
  message.num_models = early.num_models;
  constexpr int kFixedBytes = 1000;  // fields other than the list, generously
  int bytes = kFixedBytes;
  for (const EarlyObject& object : early.objects) {
    early_detection_t item = ToMessage(object);
    bytes += item.getEncodedSize();
    if (bytes > kMaxMessageBytes) break;
    message.detections.push_back(std::move(item));
  }
  message.num_detections = static_cast<std::int32_t>(message.detections.size());
  return message;
}

EarlyObjectsFromMessage FromMessage(const early_detections_t& message) {
  if (message.num_detections < 0 || message.num_models < 0 ||
      message.detections.size() != static_cast<std::size_t>(message.num_detections)) {
    return {std::nullopt, "a count does not fit its list"};
  }
  const std::optional<Eigen::Isometry3d> T_local_sensor =
      LevelPoseFrom(message.sensor_position, message.sensor_orientation);
  if (!T_local_sensor) return {std::nullopt, "sensor pose is not a pose"};
  StampedEarlyObjects early;
  early.utime = message.utime;
  early.known_until = message.utime_end;
  early.is_final = message.is_final != 0;
  early.T_local_sensor = *T_local_sensor;
  early.num_models = message.num_models;
  for (const early_detection_t& item : message.detections) {
    DetectionFromMessage converted = FromMessage(item.detection);
    if (!converted.detection) return {std::nullopt, std::move(converted.error)};
    if (item.status < early_detection_t::STATUS_NEW ||
        item.status > early_detection_t::STATUS_WITHDRAWN) {
      return {std::nullopt, "a status is unknown"};
    }
    if (!(item.unseen_share >= 0.0 && item.unseen_share <= 1.0))
      return {std::nullopt, "a share is not within 0 .. 1"};
    early.objects.push_back({item.id, static_cast<EarlyStatus>(item.status), Time(item.first_utime),
                             item.unseen_share, std::move(*converted.detection)});
  }
  return {std::move(early), ""};
}

}  // namespace rimod
