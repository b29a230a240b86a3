#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "io/config.h"
#include "io/process_options.h"
#include "viewer_tools/snapshot.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Draws what was found: each scan's range image and the view from above, with the objects "
      "drawn in, as PNG files. Give either a LOG recorded with lcm-logger that holds range images "
      "and detections, or a scan file with rimod-detect's output for it.",
      "rimod-snapshot");
  rimod::SnapshotOptions options;
  rimod::CommonOptions common;
  rimod::BusOptions bus;
  rimod::AddCommonOptions(&app, &common);
  app.add_option("--models", options.models, "Folder with the models that were looked for")
      ->required()
      ->type_name("DIR");
  CLI::Option* log = app.add_option("log", options.log, "LCM log")->type_name("LOG");
  CLI::Option* scan =
      app.add_option("--scan", options.scan, "Scan file, instead of a log")->type_name("SCAN");
  CLI::Option* detections =
      app.add_option("--detections", options.detections, "What rimod-detect printed for it")
          ->type_name("FILE.jsonl");
  app.add_option("--output", options.output, "Folder for the pictures; made when missing")
      ->required()
      ->type_name("DIR");
  app.add_option("--max-scans", options.max_scans, "Draw no more than so many scans")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app.add_option("--channel", bus.renamings, "The log has another name for a channel: NAME=OTHER")
      ->allow_extra_args(false)
      ->type_name("NAME=OTHER");
  scan->needs(detections)->excludes(log);
  detections->needs(scan);
  if (const std::optional<int> exit_code = rimod::ParseCommandLine(&app, argc, argv))
    return *exit_code;
  rimod::LogToStderr(app.get_name());

  const rimod::ChannelsResult channels = rimod::ChannelsFrom(bus);
  const rimod::ConfigurationResult configuration =
      common.config.empty()
          ? rimod::ConfigurationResult{rimod::DefaultConfiguration(rimod::Method::kDefault), ""}
          : rimod::ReadConfiguration(common.config);
  std::string error = channels.error + configuration.error;
  if (error.empty() && options.log.empty() && options.scan.empty())
    error = "neither a LOG nor --scan is given; --help tells more";
  if (!error.empty()) {
    spdlog::error(error);
    return 2;
  }
  options.channels = *channels.channels;
  options.params = configuration.configuration->pipeline;
  return rimod::RunSnapshot(options);
}
