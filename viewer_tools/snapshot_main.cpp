#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "io/bus_setup.h"
#include "io/process_options.h"
#include "viewer_tools/snapshot.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Draws what was found: a picture of each scan's range image and one from above, with the\n"
      "objects drawn in. Takes a log of lcm-logger that holds range images and detections, or a\n"
      "scan with rimod-detect's output for it. Prints the pictures' paths on stdout.\n\n"
      "Examples: rimod-snapshot --models models --output pictures recorded.lcm\n"
      "          rimod-snapshot --models models --output pictures --scan a.pcd --detections "
      "a.jsonl\n",
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
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  app.add_option("--channel", bus.renamings, "The log has another name for a channel: NAME=OTHER")
      ->allow_extra_args(false)
      ->type_name("NAME=OTHER");
  app.footer("Exit codes: 0 done; 1 something could not be read or written; 2 bad usage.");
  scan->needs(detections)->excludes(log);
  detections->needs(scan);
  if (const std::optional<int> exit_code = rimod::ParseCommandLine(&app, argc, argv))
    return *exit_code;
  rimod::LogToStderr(app.get_name());

  const std::optional<rimod::Configuration> configuration = rimod::LoadConfiguration(common);
  if (!configuration) return 2;
  const rimod::ChannelsResult channels = rimod::ChannelsFrom(bus);
  std::string error = channels.error;
  if (options.log.empty() && options.scan.empty()) error = "give a LOG or --scan; see --help";
  if (!error.empty()) {
    spdlog::error("{}", error);
    return 2;
  }
  options.channels = *channels.channels;
  options.params = configuration->pipeline;
  return rimod::RunSnapshot(options);
}
