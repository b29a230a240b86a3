#pragma once

#include <memory>
#include <string>

#include "io/process_options.h"
#include "web_viewer/scan_history.h"
#include "web_viewer/web_server.h"

namespace CLI {
class App;
}

namespace rimod {

struct WebOptions {
  CommonOptions common;
  BusOptions bus;
  WebServerOptions server;
  std::string log;      // empty: live
  double speed = 1.0;   // of the log
  std::string models;   // folder; empty: objects are drawn as boxes
  std::string page;     // folder; empty: beside the executable, as it was built
  int num_threads = 0;  // of the detector, for logs without detections
  HistoryLimits history;
};

// The command line; options must outlive it.
std::unique_ptr<CLI::App> MakeWebApp(WebOptions* options);

// Serves the page until a signal comes. Returns the exit code.
int RunWeb(const WebOptions& options);

}  // namespace rimod
