#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io/event_log.h"
#include "io/process_options.h"
#include "io/raw_subscription.h"
#include "io/tempo.h"
#include "rimod/status_t.hpp"

namespace rimod {

// What a process on the bus shall replay instead of joining the bus.
struct ReplayOptions {
  std::string log;     // of lcm-logger; empty: none, the process runs live
  std::string out;     // log for what the process sends; empty: it is not kept
  std::string timing;  // file for stage times; empty: none
  bool wanted() const { return !log.empty(); }
};

// Adds --replay, --out and --timing.
void AddReplayOptions(CLI::App* app, ReplayOptions* options);

// The same, except that in a replay messages stay within the process.
BusOptions BusForReplay(BusOptions bus, const ReplayOptions& replay);

// Feeds one process the events of a log at full speed, without a network, and writes what it sends
// to another log, each message with the time of the input event that it follows from. RIMOD_STATUS
// is left out: it tells of this run and not of the log.
class LogReplay {
 public:
  // lcm: of BusForReplay; the process, made after this object, has it for input and output. Of what
  // it sends, out_channels are written, in the order of sending.
  LogReplay(ReplayOptions options, lcm::LCM* lcm, const std::vector<std::string>& out_channels,
            const std::string& status_channel);
  LogReplay(const LogReplay&) = delete;
  LogReplay& operator=(const LogReplay&) = delete;

  // For the process; this object must outlive it.
  Tempo tempo();

  // Replays all of the log; on_idle is called as RunBus does by the log's clock, and at the end
  // until nothing waits any more. Tells stage times, losses and errors on stderr. Returns the exit
  // code: 0 done, 1 the log was damaged (its whole events were used), held nothing for this
  // process, was stopped, or an output could not be written.
  int Run(const std::atomic<bool>& stop, const std::function<void()>& on_idle);

 private:
  void OnStageTimes(std::int64_t utime, const StageTimes& times);
  void Handle(const LogEvent& event);
  void HandleWaiting();
  void Advance(std::int64_t utime, const std::function<void()>& on_idle);
  std::string OnStatus(status_t status);
  void ReportTimes(double total_ms) const;
  void ReportLosses() const;
  bool WriteOutputs();

  const ReplayOptions options_;
  lcm::LCM* lcm_;
  std::set<std::string> own_channels_;
  std::optional<EventLogWriter> writer_;
  Tempo::Time now_{};                       // the log's clock, from 0 at its first event
  Tempo::Time last_idle_{};                 // when the process last looked at what waits
  std::optional<std::int64_t> event_time_;  // us, of the event at hand
  std::optional<status_t> status_;          // the last
  std::int64_t num_sent_ = 0;
  std::vector<std::pair<std::string, std::vector<double>>> stages_;  // ms, as first seen
  std::vector<std::pair<std::int64_t, StageTimes>> scans_;
  std::vector<std::unique_ptr<BytesSubscription>> subscriptions_;
};

// Runs a process as its command line wants: on the bus, or through a log.
class ProcessRun {
 public:
  // As LogReplay, where a log is wanted.
  ProcessRun(const ReplayOptions& replay, lcm::LCM* lcm,
             const std::vector<std::string>& out_channels, const std::string& status_channel);

  // For the process; this object must outlive it.
  Tempo tempo() { return replay_ ? replay_->tempo() : Tempo(); }

  // Returns the exit code: that of the replay; live 0 when stopped, 1 when LCM fails (RunBus).
  int Run(const std::atomic<bool>& stop, const std::function<void()>& on_idle,
          std::chrono::milliseconds idle_period = std::chrono::milliseconds(50));

 private:
  lcm::LCM* lcm_;
  std::optional<LogReplay> replay_;
};

}  // namespace rimod
