#pragma once

#include <string>

#include "io/channels.h"

namespace rimod {

struct TopOptions {
  std::string log;        // empty: live
  bool once = false;      // live: listen for a while, print once and end
  bool json = false;      // a line of JSON for each report, no tables
  double listen = 3.5;    // s, how long once listens: every process tells its status each second
  double interval = 1.0;  // s, between reports
  CloudChannels clouds;   // where scans come as point clouds, too
};

// Joins the bus and shows what goes on there until a signal comes, or once. Returns the exit code:
// 1 when the bus cannot be joined or nothing of the pipeline was heard in time.
int TopLive(const std::string& lcm_url, const Channels& channels, const TopOptions& options);

// Sums up a log of lcm-logger. Returns the exit code: 1 when it could not be read in full or holds
// nothing of the pipeline.
int TopLog(const Channels& channels, const TopOptions& options);

}  // namespace rimod
