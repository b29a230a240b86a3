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

}  // namespace rimod
