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
#include "io/status_reporter.h"
#include "rimod/sweep_assembler.h"

namespace rimod {

// Laser lines and poses in, a scan out at the end of each sweep; on demand also what a sweep has
// grown by, every early.period of it.
class AssemblerProcess {
 public:
  // Both LCM instances (they may be one) must outlive the process.
  AssemblerProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                   const Configuration& configuration, bool tell_growth = false);

  // To be called many times a second: sends the scan of a sweep as soon as its lines stop, ends the
  // sweep when nothing comes any more, reports.
  void OnIdle();

 private:
  std::string OnLine(const bot_core::planar_lidar_t& message);
  std::string OnPose(const bot_core::rigid_transform_t& message);
  void NoteInput();
  bool LinesStopped() const;
  void PublishEnded(const std::vector<Sweep>& sweeps);
  void PublishUnended();
  void PublishScan(const Sweep& sweep);
  void PublishGrowth();
  void ReportCounters();

  using Clock = std::chrono::steady_clock;
  struct SentScan {
    Time begin, end;
    int num_lines = 0;
  };

  const std::string scan_channel_;
  const std::string partial_scan_channel_;
  const bool tell_growth_;
  const double growth_period_;  // s
  const std::chrono::duration<double> idle_time_, quiet_time_;
  SweepAssembler assembler_;
  Clock::duration assembly_time_{0};  // spent on the sweep at hand
  Clock::time_point last_input_;
  Clock::duration longest_gap_{0};  // between inputs of the sweep at hand
  bool looked_ = false;             // at the sweep at hand since the last input
  std::optional<SentScan> sent_;    // of the sweep at hand, before its end
  StatusReporter status_;
  PacedPublisher publisher_;
  std::vector<std::unique_ptr<BytesSubscription>> subscriptions_;
};

}  // namespace rimod
