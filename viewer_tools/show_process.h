#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io/channels.h"
#include "io/raw_subscription.h"
#include "io/stage_timer.h"
#include "rimod/detections_t.hpp"
#include "rimod/status_t.hpp"

namespace rimod {

// When live tables end.
struct ShowLimits {
  std::set<std::string> awaited;  // stop when all these processes have told their status
  int max_scans = 0;              // stop after so many; 0: never
  std::optional<std::chrono::duration<double>> patience;  // give up when neither came for so long
};

// Prints a table for each detections message on the bus, with the stage times that the processes
// last told, on stdout.
class ShowProcess {
 public:
  ShowProcess(lcm::LCM* lcm, const Channels& channels, const ShowLimits& limits);

  // True when the limits are reached.
  bool Done() const;
  // True when it gave up waiting.
  bool GaveUp() const;

 private:
  std::string OnDetections(const detections_t& message);
  std::string OnStatus(const status_t& message);

  ShowLimits limits_;
  int num_scans_ = 0;
  std::chrono::steady_clock::time_point last_scan_;
  std::map<std::string, StageTimes> process_times_;
  std::set<std::string> told_;  // complaints, each once
  std::vector<std::unique_ptr<BytesSubscription>> subscriptions_;
};

// Joins the bus and prints tables until the limits are reached or a signal comes. Returns the exit
// code: 1 when the bus cannot be joined or patience ran out.
int ShowLive(const std::string& lcm_url, const Channels& channels, const ShowLimits& limits);

// Prints the same tables for every scan in a log. Returns the exit code: 1 when something could not
// be read.
int ShowLog(const std::string& path, const Channels& channels);

}  // namespace rimod
