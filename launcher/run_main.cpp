#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "io/bus.h"
#include "io/process_options.h"
#include "io/version.h"
#include "launcher/run_file.h"
#include "launcher/supervisor.h"

int main(int argc, char** argv) {
  const rimod::StopOnSignal signals;
  CLI::App app(
      "Runs the processes that a file lists, starts anew what ends, with a growing pause, and\n"
      "stops all of them on SIGINT or SIGTERM. config/run.yaml is an example, docs/running.md has\n"
      "the keys. The processes inherit the environment, e.g. LCM_DEFAULT_URL.\n\n"
      "Example: rimod-run config/run.yaml\n",
      "rimod-run");
  std::string path;
  bool check = false;
  app.set_version_flag("--version", app.get_name() + " " + rimod::Version(),
                       "Print the version and exit");
  app.add_option("--config,file", path, "Which processes, how they restart and stop (YAML)")
      ->required()
      ->type_name("FILE.yaml");
  app.add_flag("--check", check, "Read the file, look for the executables, start nothing");
  app.footer(
      "Exit codes: 0 all ended well; 1 one had to be killed or failed for good; 2 bad usage,\n"
      "a bad file, an executable that is not there.");
  if (const std::optional<int> exit_code = rimod::ParseCommandLine(&app, argc, argv))
    return *exit_code;
  rimod::LogToStderr(app.get_name());

  const rimod::RunFileResult result = rimod::ReadRunFile(path);
  if (!result.run_file) {
    spdlog::error("{}", result.error);
    return 2;
  }
  if (check) return 0;
  return rimod::Supervisor(*result.run_file).Run(signals.stop());
}
