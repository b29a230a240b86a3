#pragma once

#include <lcm/lcm-cpp.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/raw_subscription.h"
#include "io/status_reporter.h"
#include "io/tempo.h"
#include "rimod/status_t.hpp"

namespace rimod {

// Notices other processes that send on the channels of this one, where only one should: each tells
// in RIMOD_STATUS where it sends, "sends <channel>", and listens to what the others tell. Who is
// not alone says so there: "other senders on <channel>" is how many were heard of late, and the
// last error names one.
class SenderWatch {
 public:
  // lcm and reporter must outlive it. channels: what this process sends its results on.
  SenderWatch(lcm::LCM* lcm, const std::string& status_channel, std::vector<std::string> channels,
              StatusReporter* reporter);

  // To be called many times a second.
  void Report(Tempo::Time now);

 private:
  struct Other {
    Tempo::Time heard;
    std::vector<std::string> channels;  // of ours
  };
  std::string OnStatus(const status_t& status);

  const std::vector<std::string> channels_;
  StatusReporter* reporter_;
  const status_t self_;
  Tempo::Time now_;
  std::map<std::string, Other> others_;  // by "executable, host, pid"
  std::unique_ptr<BytesSubscription> subscription_;
};

}  // namespace rimod
