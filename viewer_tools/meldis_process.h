#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "io/bus_params.h"
#include "io/channels.h"
#include "io/raw_subscription.h"
#include "viewer_tools/scan_follower.h"

namespace rimod {

// Tells meldis what the pipeline sees: the newest scan with what was found in it, anew when it
// changes, twice a second at most, and again from time to time for a meldis that was started later.
class MeldisProcess {
 public:
  MeldisProcess(lcm::LCM* lcm, const Channels& channels, const BusParams& params);

  // To be called again and again, after messages were handled.
  void OnIdle();

 private:
  void Take(const std::string& channel, const void* bytes, std::size_t size);
  void Complain(const std::string& channel, const std::string& cause);
  void Send(const ViewedScan& scan);

  lcm::LCM* lcm_;
  ScanFollower follower_;
  std::int64_t sent_version_ = -1;
  std::chrono::steady_clock::time_point sent_at_;
  std::set<std::string> told_;  // complaints, each once
  std::vector<std::unique_ptr<BytesSubscription>> subscriptions_;
};

}  // namespace rimod
