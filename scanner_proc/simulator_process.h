#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "io/process_options.h"
#include "rimod/sweep.h"
#include "scanner_proc/scene.h"
#include "scanner_proc/simulated_sweeps.h"

namespace CLI {
class App;
}

namespace rimod::simulation {

// The command line of rimod-simulator.
struct SimulatorOptions {
  CommonOptions common;
  BusOptions bus;
  std::string scene;  // path
  SweepFiles files;
  std::string recording;  // folder; empty: none
  double speed = 1.0;     // of the published time; 0: as fast as receivers can follow
  int num_sweeps = 1;     // 0: until stopped
  std::optional<std::int64_t> seed;
  std::optional<int> num_views;
};

void AddSimulatorOptions(CLI::App* app, SimulatorOptions* options);

// Scans a simulated scene: writes files or plays the scanner on the bus.
class SimulatorProcess {
 public:
  explicit SimulatorProcess(SimulatorOptions options) : options_(std::move(options)) {}

  // Returns the exit code.
  int Run(const std::atomic<bool>& stop);

 private:
  std::string CheckOptions() const;
  int RunOffline(const SweepParams& params, const std::atomic<bool>& stop) const;
  int RunLive(const std::atomic<bool>& stop) const;

  SimulatorOptions options_;
  Scene scene_;
  Channels channels_;
};

}  // namespace rimod::simulation
