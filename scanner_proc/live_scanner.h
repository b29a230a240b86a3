#pragma once

#include <atomic>
#include <cstdint>

#include "io/channels.h"
#include "scanner_proc/scene.h"

namespace lcm {
class LCM;
}

namespace rimod::simulation {

struct LiveResult {
  std::int64_t num_lines = 0;
  std::int64_t num_late = 0;    // lines that came over a tenth of a second after their time
  std::int64_t num_failed = 0;  // messages that LCM refused to send
};

// Plays the scanner in the scene on LASER and LASER_TO_LOCAL: num_sweeps sweeps (0: until stopped),
// speed times faster than real time. Speed 0: as fast as receivers with a stock socket buffer
// follow. Messages are stamped with the scanner's time, beginning now. Tells RIMOD_STATUS once a
// second.
LiveResult PublishSweeps(const Scene& scene, int num_sweeps, double speed, const Channels& channels,
                         lcm::LCM* lcm, const std::atomic<bool>& stop);

}  // namespace rimod::simulation
