#pragma once

#include <vector>

#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/rigid_transform_t.hpp"
#include "rimod/sweep_assembler.h"
#include "tests/support/ray_caster.h"

namespace rimod {

// What a laser that tilts down steadily in front of a world measures: lines and the pose at each
// line's begin, one more after the last. As messages: another conversion would round poses again.
struct TiltingLaser {
  std::vector<bot_core::planar_lidar_t> lines;
  std::vector<bot_core::rigid_transform_t> poses;
};
TiltingLaser TiltInFrontOf(const World& world, Time begin, int num_lines);

// The sweeps that the assembler makes of it.
std::vector<Sweep> Assemble(const TiltingLaser& laser, const SweepParams& params);

// A floor, a wall, a ball and a box in front of the sensor at (0, 0, 1).
World SmallRoom();

}  // namespace rimod
