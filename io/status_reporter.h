#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/raw_subscription.h"
#include "io/section_joiner.h"
#include "io/stage_timer.h"
#include "io/tempo.h"
#include "rimod/status_t.hpp"

namespace lcm {
class LCM;
}

namespace rimod {

// Counts what a process does and publishes it on RIMOD_STATUS. All methods may be called from any
// thread. What goes wrong is logged too, each kind (channel and cause) once.
class StatusReporter {
 public:
  StatusReporter(lcm::LCM* lcm, std::string channel, std::string process, Tempo tempo = {});

  void CountIn();
  void CountOut();
  // A scan, or parts of it, given up; cause is a short name such as "scans overtaken". Goes out as
  // counter "dropped <cause>".
  void CountDropped(const std::string& cause, std::int64_t number = 1);
  // A message that could not be used; counter "rejected <channel>: <cause>".
  void CountRejected(const std::string& channel, const std::string& cause);
  // A named number of one's own; must not fall. When counts_as_dropped its growth counts as dropped
  // and its name goes out as "dropped <name>".
  void SetCounter(const std::string& name, std::int64_t value, bool counts_as_dropped = false);
  // A named number that may fall: what is now (io/status_counters.h).
  void SetGauge(const std::string& name, std::int64_t value);
  // What a joiner saw: counters "<name> sections duplicated" and so on; wholes that were given up
  // count as dropped, sections with bad numbers as rejected.
  void SetSectionCounters(const std::string& name, const SectionCounters& counters);
  // The stages of one scan; the status has each stage's median over the last scans.
  void AddStageTimes(const StageTimes& times);
  // Logs an error, each kind once, and keeps it as the last.
  void ReportError(const std::string& kind, const std::string& text);

  // Observer that counts a subscription's messages here; this object must outlive it.
  SubscriptionObserver MakeObserver();

  // Publishes when a second has passed since the last time.
  void PublishIfDue();
  void Publish();
  // Everything so far, and what the process takes of the machine now.
  status_t Snapshot() const;

 private:
  // With the mutex held:
  std::int64_t& Counter(const std::string& name);
  // Sets a counter; returns by how much it grew.
  std::int64_t Raise(const std::string& name, std::int64_t value);
  void LogOnce(const std::string& kind, const std::string& text);

  mutable std::mutex mutex_;
  lcm::LCM* lcm_;
  std::string channel_;
  const Tempo tempo_;
  status_t totals_;                                                      // without lists
  std::map<std::string, std::int64_t> counters_;                         // by name
  std::vector<std::pair<std::string, std::deque<double>>> stage_times_;  // as first seen
  std::set<std::string> logged_;                                         // kinds
  std::chrono::steady_clock::time_point next_publish_;
};

}  // namespace rimod
