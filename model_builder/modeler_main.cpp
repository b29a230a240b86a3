// rimod-modeler: builds an object's model from a recording, a point cloud or a mesh.

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "model_builder/modeler_options.h"

int main(int argc, char** argv) {
  constexpr int kFailed = 1;
  constexpr int kBadUsage = 2;
  rimod::ModelerCommandLine command_line;
  const std::unique_ptr<CLI::App> app = rimod::MakeModelerApp(&command_line);
  if (const auto exit_code = rimod::ParseCommandLine(app.get(), argc, argv)) return *exit_code;
  rimod::LogToStderr("rimod-modeler");

  const rimod::ConfigurationResult config = rimod::ReadConfiguration(command_line.common.config);
  if (!config.configuration) {
    spdlog::error("{}", config.error);
    return kBadUsage;
  }
  try {
    return rimod::RunModeler(command_line.options, *config.configuration);
  } catch (const std::exception& exception) {
    spdlog::error("{}", exception.what());
    return kFailed;
  }
}
