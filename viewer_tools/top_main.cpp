#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "io/bus_setup.h"
#include "io/process_options.h"
#include "viewer_tools/top_command.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Shows how the pipeline runs: each process with its rate, processor, memory, queue and what\n"
      "it dropped and rejected by cause (rimod.status_t on RIMOD_STATUS), and each stage's output\n"
      "with its rate and the time from the end of the scan until it was there.\n\n"
      "Examples: rimod-top\n"
      "          rimod-top --once --json\n"
      "          rimod-top recorded.lcm\n",
      "rimod-top");
  rimod::CommonOptions common;
  rimod::BusOptions bus;
  rimod::TopOptions options;
  rimod::AddCommonOptions(&app, &common);
  rimod::AddBusOptions(&app, &bus);
  app.add_option("log", options.log, "A log of lcm-logger; without it the bus")->type_name("LOG");
  rimod::AddCloudOptions(&app, &options.clouds);
  app.add_flag("--once", options.once, "Live: listen for a while, print once and end");
  app.add_flag("--json", options.json, "A line of JSON for each report; docs/running.md has keys");
  app.add_option("--listen", options.listen, "How long --once listens")
      ->check(CLI::Range(0.1, 1e6))
      ->type_name("SECONDS")
      ->capture_default_str();
  app.add_option("--interval", options.interval, "Live: time between reports")
      ->check(CLI::Range(0.1, 1e6))
      ->type_name("SECONDS")
      ->capture_default_str();
  app.footer("Exit codes: 0 done; 1 nothing came, or something could not be read; 2 bad usage.");
  if (const std::optional<int> exit_code = rimod::ParseCommandLine(&app, argc, argv))
    return *exit_code;
  rimod::LogToStderr(app.get_name());

  if (!rimod::LoadConfiguration(common)) return 2;
  const rimod::ChannelsResult channels = rimod::ChannelsFrom(bus);
  if (!channels.channels) {
    spdlog::error("{}", channels.error);
    return 2;
  }
  const int exit_code = options.log.empty()
                            ? rimod::TopLive(rimod::LcmUrl(bus), *channels.channels, options)
                            : rimod::TopLog(*channels.channels, options);
  return rimod::CheckStdout(exit_code);
}
