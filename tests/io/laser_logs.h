#pragma once

#include <cmath>
#include <string>

#include "io/event_log.h"
#include "io/laser_messages.h"
#include "io/message_codec.h"
#include "io/scan_messages.h"

namespace rimod {

template <typename Message>
void WriteMessage(EventLogWriter* log, const std::string& channel, std::int64_t utime,
                  const Message& message) {
  const std::vector<std::uint8_t> bytes = EncodeMessage(message);
  log->Write(utime, channel, bytes.data(), bytes.size());
}

// Writes LASER and LASER_TO_LOCAL of a scanner in the middle of a sphere of 5 m whose tilt swings
// to and fro, num_sweeps times by 0.6 rad in 1.2 s, the first line at 1 s. Lines of 19 beams over
// 180 degrees, the last without a return.
inline void WriteSwings(int num_sweeps, EventLogWriter* log) {
  constexpr double kLineDuration = 0.02667, kSwing = 0.6, kSwingDuration = 1.2;  // s, rad, s
  const int num_lines = static_cast<int>(num_sweeps * kSwingDuration / kLineDuration);
  for (int i = 0; i <= num_lines; ++i) {
    const Time time(1'000'000 + static_cast<std::int64_t>(i * kLineDuration * 1e6));
    const double phase = std::fmod(i * kLineDuration / kSwingDuration, 2.0);
    const double tilt = kSwing * (phase < 1.0 ? phase : 2.0 - phase) - kSwing / 2.0;
    TimedPose pose;
    pose.time = time;
    pose.T_local_laser.linear() =
        Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()).toRotationMatrix();
    WriteMessage(log, "LASER_TO_LOCAL", time.count(), ToMessage(pose));
    LaserLine line;
    line.time = time;
    line.first_angle = -M_PI / 2.0;
    line.angle_step = M_PI / 18.0;
    line.ranges.assign(19, 5.0f);
    line.ranges.back() = 81.91f;
    if (i < num_lines) WriteMessage(log, "LASER", time.count(), ToMessage(line));
  }
}

}  // namespace rimod
