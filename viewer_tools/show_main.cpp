#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "io/bus_setup.h"
#include "io/process_options.h"
#include "viewer_tools/show_process.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Prints what was found as tables: class, position, heading, score, and the stages' times.\n"
      "Reads rimod.detections_t on RIMOD_DETECTIONS and rimod.status_t on RIMOD_STATUS, live or\n"
      "from a log of lcm-logger.\n\n"
      "Examples: rimod-show recorded.lcm\n"
      "          rimod-show live --count 1 --timeout 60\n",
      "rimod-show");
  rimod::CommonOptions common;
  rimod::BusOptions bus;
  rimod::ShowLimits limits;
  std::string source;
  double timeout = 0.0;  // s
  rimod::AddCommonOptions(&app, &common);
  rimod::AddBusOptions(&app, &bus);
  app.add_option("source", source, "A log, or the word live")->required()->type_name("LOG|live");
  app.add_option("--count", limits.max_scans, "live: stop after so many scans")
      ->check(CLI::Range(1, 1000000000))
      ->type_name("N");
  std::vector<std::string> awaited;
  app.add_option("--await", awaited, "live: stop when this process has told its status; repeatable")
      ->allow_extra_args(false)
      ->type_name("PROCESS");
  CLI::Option* patience =
      app.add_option("--timeout", timeout, "live: fail when nothing came for so many seconds")
          ->check(CLI::Range(0.1, 1e6))
          ->type_name("SECONDS");
  app.footer("Exit codes: 0 done; 1 something could not be read, nothing came; 2 bad usage.");
  if (const std::optional<int> exit_code = rimod::ParseCommandLine(&app, argc, argv))
    return *exit_code;
  rimod::LogToStderr(app.get_name());
  limits.awaited.insert(awaited.begin(), awaited.end());
  if (!patience->empty()) limits.patience = std::chrono::duration<double>(timeout);

  if (!rimod::LoadConfiguration(common)) return 2;
  const rimod::ChannelsResult channels = rimod::ChannelsFrom(bus);
  if (!channels.channels) {
    spdlog::error("{}", channels.error);
    return 2;
  }
  const int exit_code = source == "live"
                            ? rimod::ShowLive(rimod::LcmUrl(bus), *channels.channels, limits)
                            : rimod::ShowLog(source, *channels.channels);
  return rimod::CheckStdout(exit_code);
}
