#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "web_viewer/web_command.h"

int main(int argc, char** argv) {
  rimod::WebOptions options;
  const std::unique_ptr<CLI::App> app = rimod::MakeWebApp(&options);
  if (const std::optional<int> exit_code = rimod::ParseCommandLine(app.get(), argc, argv))
    return *exit_code;
  rimod::LogToStderr(app->get_name());
  try {
    return rimod::RunWeb(options);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
}
