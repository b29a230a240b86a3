#pragma once

#include <optional>
#include <string>

#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/rigid_transform_t.hpp"
#include "rimod/sweep_assembler.h"

namespace rimod {

struct LaserLineFromMessage {
  std::optional<LaserLine> line;
  std::string error;  // the cause; empty when there is a line
};
// Counts that do not fit the lists, angles that are not finite, lines without a beam give an error.
// Single ranges that are not finite stay: the assembler counts them.
LaserLineFromMessage FromMessage(const bot_core::planar_lidar_t& message);

struct TimedPoseFromMessage {
  std::optional<TimedPose> pose;
  std::string error;
};
// Values that are not finite and quaternions that are not unit within 1 % give an error.
TimedPoseFromMessage FromMessage(const bot_core::rigid_transform_t& message);

// Intensities stay empty.
bot_core::planar_lidar_t ToMessage(const LaserLine& line);
bot_core::rigid_transform_t ToMessage(const TimedPose& pose);

}  // namespace rimod
