#pragma once

#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/rigid_transform_t.hpp"
#include "io/channels.h"
#include "io/config.h"
#include "io/paced_publisher.h"
#include "io/raw_subscription.h"
#include "io/sender_watch.h"
#include "io/status_reporter.h"
#include "io/tempo.h"
#include "rimod/sweep_assembler.h"
#include "scanner_proc/line_silence.h"

namespace rimod {

// Laser lines and poses in, a scan out at the end of each sweep. Before that what the sweep has
// grown by, so that the extractor has nearly all of the scan when the sweep ends; on demand every
// early.period, to be looked at early.
class AssemblerProcess {
 public:
  // Both LCM instances (they may be one) must outlive the process.
  AssemblerProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                   const Configuration& configuration, bool tell_growth = false,
                   const Tempo& tempo = {});

  // To be called many times a second: sends the scan of a sweep as soon as its lines stop, ends the
  // sweep when nothing comes any more, reports. Where it is called late the machine is busy, and
  // the time in between does not count as silence.
  void OnIdle();

 private:
  std::string OnLine(const bot_core::planar_lidar_t& message);
  std::string OnPose(const bot_core::rigid_transform_t& message);
  template <typename Input>
  void Take(Input input);
  void PublishEnded(const std::vector<Sweep>& sweeps);
  void PublishUnended();
  void PublishScan(const Sweep& sweep);
  bool PublishAhead(const Sweep& sweep);
  void PublishGrowth(const std::string& channel, double min_duration);
  void ReportCounters();

  using Clock = std::chrono::steady_clock;
  struct SentScan {
    Time begin, end;
    int num_lines = 0;
  };

  const Tempo tempo_;
  const std::string scan_channel_, scan_ahead_channel_, scan_end_channel_;
  const bool scan_ahead_;  // growth is sent ahead of the scan
  const std::string growth_channel_;
  const double growth_period_;  // s, infinite where growth is not sent
  const std::chrono::duration<double> idle_time_;
  SweepAssembler assembler_;
  Clock::duration assembly_time_{0};  // spent on the sweep at hand
  Clock::time_point last_input_;
  LineSilence silence_;
  std::int64_t num_lines_seen_ = 0;  // when the sweep at hand was last looked at
  bool known_end_told_ = false;      // of the sweep at hand
  std::optional<SentScan> sent_;     // of the sweep at hand, before its end
  StatusReporter status_;
  SenderWatch senders_;
  PacedPublisher publisher_;
  std::vector<std::unique_ptr<BytesSubscription>> subscriptions_;
};

}  // namespace rimod
