#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/pointcloud2_t.hpp"
#include "bot_core/rigid_transform_t.hpp"
#include "rimod/detections_t.hpp"
#include "rimod/early_detections_t.hpp"
#include "rimod/feature_set_t.hpp"
#include "rimod/object_model_t.hpp"
#include "rimod/partial_feature_set_t.hpp"
#include "rimod/partial_range_image_t.hpp"
#include "rimod/partial_scan_t.hpp"
#include "rimod/pose_hypotheses_t.hpp"
#include "rimod/range_image_t.hpp"
#include "rimod/scan_t.hpp"
#include "rimod/shard_scan_t.hpp"
#include "rimod/shard_turn_t.hpp"
#include "rimod/status_t.hpp"

namespace rimod {

// Calls visit with a null pointer to each type that our programs take from outside, in turn.
template <typename Visit>
void ForEachMessageType(const Visit& visit) {
  visit(static_cast<bot_core::planar_lidar_t*>(nullptr));
  visit(static_cast<bot_core::rigid_transform_t*>(nullptr));
  visit(static_cast<bot_core::pointcloud2_t*>(nullptr));
  visit(static_cast<scan_t*>(nullptr));
  visit(static_cast<range_image_t*>(nullptr));
  visit(static_cast<feature_set_t*>(nullptr));
  visit(static_cast<object_model_t*>(nullptr));
  visit(static_cast<pose_hypotheses_t*>(nullptr));
  visit(static_cast<detections_t*>(nullptr));
  visit(static_cast<partial_scan_t*>(nullptr));
  visit(static_cast<partial_range_image_t*>(nullptr));
  visit(static_cast<partial_feature_set_t*>(nullptr));
  visit(static_cast<early_detections_t*>(nullptr));
  visit(static_cast<shard_scan_t*>(nullptr));
  visit(static_cast<shard_turn_t*>(nullptr));
  visit(static_cast<status_t*>(nullptr));
}

// The encoded message whose fields these bytes are.
template <typename Message>
std::vector<std::uint8_t> WithFingerprint(const std::uint8_t* fields, std::size_t size) {
  std::vector<std::uint8_t> bytes;
  const auto hash = static_cast<std::uint64_t>(Message::getHash());
  for (int shift = 56; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<std::uint8_t>(hash >> shift));
  bytes.insert(bytes.end(), fields, fields + size);
  return bytes;
}

}  // namespace rimod
