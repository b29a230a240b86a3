#pragma once

#include <optional>
#include <string>

#include "bot_core/pointcloud2_t.hpp"
#include "rimod/cloud_placer.h"

namespace rimod {

struct SensorCloudFromMessage {
  std::optional<SensorCloud> cloud;
  std::string error;  // the cause; empty when there is a cloud (maybe without a point)
};
// A point cloud's fields "x", "y", "z": FLOAT32 or FLOAT64 of either byte order, at any offset, in
// rows with or without padding. Points that are not finite and those at the origin (what drivers
// give for beams without a return) are left out. Missing, repeated or overlong fields, fields of
// other types, counts and steps that do not fit each other or the bytes give an error.
SensorCloudFromMessage FromMessage(const bot_core::pointcloud2_t& message);

// An unordered cloud of FLOAT32 x, y, z in this machine's byte order.
bot_core::pointcloud2_t ToMessage(const SensorCloud& cloud, const std::string& frame_id);

}  // namespace rimod
