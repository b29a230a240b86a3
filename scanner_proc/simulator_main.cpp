#include <CLI/CLI.hpp>

#include "io/bus.h"
#include "io/process_options.h"
#include "scanner_proc/simulator_process.h"

int main(int argc, char** argv) {
  CLI::App app("Simulates a laser scanner on a tilting unit in a scene of your making.",
               "rimod-simulator");
  rimod::simulation::SimulatorOptions options;
  rimod::simulation::AddSimulatorOptions(&app, &options);
  if (const std::optional<int> exit_code = rimod::ParseCommandLine(&app, argc, argv)) {
    return *exit_code;
  }
  rimod::LogToStderr("rimod-simulator");
  const rimod::StopOnSignal signals;
  return rimod::simulation::SimulatorProcess(std::move(options)).Run(signals.stop());
}
