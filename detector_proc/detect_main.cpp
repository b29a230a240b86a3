// rimod-detect: finds known objects in scan files and LCM logs, without a network.

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "detector_proc/detect_options.h"

int main(int argc, char** argv) {
  constexpr int kFailed = 1;
  constexpr int kBadUsage = 2;
  rimod::DetectCommandLine command_line;
  const std::unique_ptr<CLI::App> app = rimod::MakeDetectApp(&command_line);
  if (const auto exit_code = rimod::ParseCommandLine(app.get(), argc, argv)) return *exit_code;
  rimod::LogToStderr("rimod-detect");

  const rimod::ConfigurationResult config = rimod::ReadConfiguration(command_line.common.config);
  if (!config.configuration) {
    spdlog::error("{}", config.error);
    return kBadUsage;
  }
  try {
    return rimod::RunDetect(command_line.options, *config.configuration, std::cout);
  } catch (const std::exception& exception) {
    spdlog::error("{}", exception.what());
    return kFailed;
  }
}
