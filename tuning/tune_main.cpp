// rimod-tune: finds better parameters from labelled scans.

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "io/bus.h"
#include "tuning/tune_options.h"

int main(int argc, char** argv) {
  constexpr int kFailed = 1;
  constexpr int kBadUsage = 2;
  rimod::TuneCommandLine command_line;
  const std::unique_ptr<CLI::App> app = rimod::MakeTuneApp(&command_line);
  if (const auto exit_code = rimod::ParseCommandLine(app.get(), argc, argv)) return *exit_code;
  rimod::LogToStderr("rimod-tune");

  const rimod::ConfigurationResult config = rimod::ReadConfiguration(command_line.common.config);
  if (!config.configuration) {
    spdlog::error("{}", config.error);
    return kBadUsage;
  }
  const rimod::StopOnSignal signals;
  try {
    return rimod::CheckStdout(
        rimod::RunTune(command_line.options, *config.configuration, signals.stop(), std::cout));
  } catch (const std::exception& exception) {
    spdlog::error("{}", exception.what());
    return kFailed;
  }
}
