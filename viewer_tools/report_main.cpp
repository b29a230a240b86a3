#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "io/bus_setup.h"
#include "io/process_options.h"
#include "viewer_tools/report_options.h"

int main(int argc, char** argv) {
  rimod::ReportCommandLine command_line;
  const std::unique_ptr<CLI::App> app = rimod::MakeReportApp(&command_line);
  if (const std::optional<int> exit_code = rimod::ParseCommandLine(app.get(), argc, argv))
    return *exit_code;
  rimod::LogToStderr(app->get_name());

  const std::optional<rimod::Configuration> configuration =
      rimod::LoadConfiguration(command_line.common);
  if (!configuration) return 2;
  const rimod::ChannelsResult channels = rimod::ChannelsFrom(command_line.bus);
  if (!channels.channels) {
    spdlog::error("{}", channels.error);
    return 2;
  }
  command_line.options.channels = *channels.channels;
  command_line.options.params = configuration->pipeline;
  try {
    return rimod::RunReport(command_line.options);
  } catch (const std::exception& exception) {
    spdlog::error("{}", exception.what());
    return 1;
  }
}
