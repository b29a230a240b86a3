#pragma once

#include <string>
#include <vector>

#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/rigid_transform_t.hpp"
#include "io/cloud_messages.h"
#include "io/detection_messages.h"
#include "io/early_messages.h"
#include "io/feature_messages.h"
#include "io/laser_messages.h"
#include "io/partial_messages.h"
#include "io/range_image_messages.h"
#include "io/scan_messages.h"
#include "io/shard_turn_messages.h"
#include "rimod/object_model_t.hpp"
#include "rimod/status_t.hpp"
#include "tests/io/random_answers.h"
#include "tests/io/random_values.h"

namespace rimod {

// A small valid message of each type that is read from outside, all its lists filled.
template <typename Message>
Message SampleMessage();

template <>
inline bot_core::planar_lidar_t SampleMessage() {
  bot_core::planar_lidar_t message = ToMessage(LaserLine{Time(1), 0.1, 0.2, {1.0f, 2.0f, 3.0f}});
  message.intensities = {4.0f};
  message.nintensities = 1;
  return message;
}
template <>
inline bot_core::rigid_transform_t SampleMessage() {
  return ToMessage(TimedPose{});
}
template <>
inline scan_t SampleMessage() {
  StampedScan scan;
  scan.scan = RandomValues(1).AScan(5, 3);
  return ToSections(scan)[0];
}
template <>
inline range_image_t SampleMessage() {
  return ToSections(RandomValues(1).AnImage(5, 4), 3)[0];
}
template <>
inline feature_set_t SampleMessage() {
  return ToSections(RandomValues(1).Features(3, 8), 3)[0];
}
template <>
inline object_model_t SampleMessage() {
  object_model_t message = {};
  message.num_sections = 1;
  message.name = "fan";
  message.source = "test";
  message.descriptor = "kind";
  message.descriptor_size = 2;
  message.num_points = message.num_features = message.num_validation_points = 2;
  message.num_outside_points = 2;
  for (auto* list : {&message.x,
                     &message.y,
                     &message.z,
                     &message.normal_x,
                     &message.normal_y,
                     &message.normal_z,
                     &message.feature_x,
                     &message.feature_y,
                     &message.feature_z,
                     &message.feature_normal_x,
                     &message.feature_normal_y,
                     &message.feature_normal_z,
                     &message.validation_x,
                     &message.validation_y,
                     &message.validation_z,
                     &message.validation_normal_x,
                     &message.validation_normal_y,
                     &message.validation_normal_z,
                     &message.outside_x,
                     &message.outside_y,
                     &message.outside_z}) {
    *list = {1.0f, 2.0f};
  }
  message.views.resize(2);
  for (model_view_t& view : message.views) view = {};
  message.num_views = 2;
  message.values = {1, 2, 3, 4};
  message.num_values = 4;
  return message;
}
template <>
inline pose_hypotheses_t SampleMessage() {
  return ToMessage(std::vector<PoseHypothesis>(2, {"fan", {}, 0.5, HypothesisStage::kPruned}), 2,
                   1);
}
template <>
inline detections_t SampleMessage() {
  StampedDetections detections;
  detections.detections.resize(2);
  detections.detections[0].class_name = "chair";
  detections.stage_times = {{"matching", 1.0}};
  return ToMessage(detections);
}
template <>
inline bot_core::pointcloud2_t SampleMessage() {
  return ToMessage(SensorCloud{Time(1), {{1.0f, 2.0f, 3.0f}, {4.0f, 5.0f, 6.0f}}}, "camera");
}
template <>
inline partial_scan_t SampleMessage() {
  SweepGrowth growth;
  growth.scan = RandomValues(1).AScan(5, 3);
  return ToPartialSections(growth)[0];
}
template <>
inline scan_end_t SampleMessage() {
  Sweep sweep;
  sweep.rest.emplace();
  sweep.rest->step = 2;
  return ToScanEnd(sweep);
}
template <>
inline partial_range_image_t SampleMessage() {
  return ToPartialSections(RandomValues(1).AnImage(5, 4), 3, 4)[0];
}
template <>
inline partial_feature_set_t SampleMessage() {
  return ToPartialSections(RandomValues(1).Features(3, 8), 3, 4)[0];
}
template <>
inline early_detections_t SampleMessage() {
  StampedEarlyObjects early;
  early.objects.resize(2);
  early.objects[1].detection.class_name = "chair";
  return ToMessage(early);
}
template <>
inline shard_t SampleMessage() {
  return ToMessage(Shard{"2/4", 2, 4, 5, 6, 7}, 8);
}
template <>
inline shard_scan_t SampleMessage() {
  return ToMessage(ShardScan{{"2/4", 2, 4, 5, 6, 7}, 8, 9, true});
}
template <>
inline shard_turn_t SampleMessage() {
  return ToMessage(ShardTurn{1, 2, 3, 4});
}
template <>
inline shard_candidates_t SampleMessage() {
  RandomValues random(1);
  return ToSections(RandomAnswer(&random, "2/4", 2, 3))[0];
}
template <>
inline status_t SampleMessage() {
  status_t message = {};
  message.process = "rimod-test";
  message.counters.resize(2);
  for (counter_t& counter : message.counters) counter.value = 7;
  message.num_counters = 2;
  message.stage_times.resize(1);
  message.stage_times[0].ms = 1.0;
  message.num_stage_times = 1;
  return message;
}

}  // namespace rimod
