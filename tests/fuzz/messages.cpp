// One message of any type through its decoder and our conversions. The input's first byte chooses
// the type, the others are its fields. What is decoded encodes to the same bytes.

#include <algorithm>

#include "io/cloud_messages.h"
#include "io/detection_messages.h"
#include "io/feature_messages.h"
#include "io/laser_messages.h"
#include "io/message_codec.h"
#include "io/model_messages.h"
#include "io/partial_messages.h"
#include "io/range_image_messages.h"
#include "io/scan_messages.h"
#include "io/shard_turn_messages.h"
#include "rimod/cloud_placer.h"
#include "rimod/sweep_assembler.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/message_types.h"

namespace rimod {
namespace {

void Use(const bot_core::planar_lidar_t& message) {
  LaserLineFromMessage line = FromMessage(message);
  Require(line.line.has_value() == line.error.empty(), "a line or an error");
  if (!line.line) return;
  SweepAssembler assembler(SweepParams{});
  constexpr Time kLast(1'000'000'000'000'000'000);  // the poses' own times must not overflow
  const Time time = std::clamp(line.line->time, -kLast, kLast);
  assembler.AddPose({time - Time(1000), Eigen::Isometry3d::Identity()});
  const TimedPose after = {time + Time(50000), Eigen::Isometry3d::Identity()};
  assembler.AddLine(std::move(*line.line));
  assembler.AddPose(after);
  assembler.Finish();
}
void Use(const bot_core::rigid_transform_t& message) {
  const TimedPoseFromMessage pose = FromMessage(message);
  Require(pose.pose.has_value() == pose.error.empty(), "a pose or an error");
  if (!pose.pose) return;
  SweepAssembler assembler(SweepParams{});
  assembler.AddPose(*pose.pose);
}
void Use(const bot_core::pointcloud2_t& message) {
  SensorCloudFromMessage cloud = FromMessage(message);
  Require(cloud.cloud.has_value() == cloud.error.empty(), "a cloud or an error");
  if (cloud.cloud)
    CloudPlacer(CloudParams{}, /*with_poses=*/false).AddCloud(std::move(*cloud.cloud));
}
void Use(const scan_t& message) { JoinScanSections({message}); }
void Use(const range_image_t& message) { JoinRangeImageSections({message}); }
void Use(const feature_set_t& message) { JoinFeatureSections({message}); }
void Use(const object_model_t& message) { JoinModelSections({message}); }
void Use(const pose_hypotheses_t& message) { FromMessage(message); }
void Use(const detections_t& message) { FromMessage(message); }
void Use(const partial_scan_t& message) {
  SweepGrowthFrom(message.utime, message.step, {message.section});
}
void Use(const partial_range_image_t& message) { Use(message.section); }
void Use(const partial_feature_set_t& message) { Use(message.section); }
void Use(const early_detections_t&) {}
void Use(const shard_scan_t& message) { FromMessage(message); }
void Use(const shard_turn_t& message) { FromMessage(message); }
void Use(const status_t&) {}

template <typename Message>
void Try(const std::uint8_t* fields, std::size_t size) {
  const std::vector<std::uint8_t> bytes = WithFingerprint<Message>(fields, size);
  const Decoded<Message> decoded = DecodeMessage<Message>(bytes.data(), bytes.size());
  Require(decoded.message.has_value() == decoded.error.empty(), "a message or an error");
  if (!decoded.message) return;
  Require(EncodeMessage(*decoded.message) == bytes, "a message encodes as it was");
  Use(*decoded.message);
}

}  // namespace
}  // namespace rimod

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  int type = 0;
  rimod::ForEachMessageType([&](auto* message) {
    using Message = std::remove_pointer_t<decltype(message)>;
    if (type++ == bytes[0]) rimod::Try<Message>(bytes + 1, size - 1);
  });
  return 0;
}
