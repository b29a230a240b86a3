#include "viewer_tools/view_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <string>

#include "io/bus_setup.h"
#include "io/process_options.h"

namespace rimod {
namespace {

constexpr char kDescription[] =
    "Shows what the pipeline sees and thinks, scan by scan: the range image with interest points,\n"
    "features that match, pose hypotheses before and after validation and the models found, with\n"
    "the view from above beside it. Listens on the bus, or reads a log of lcm-logger or a scan\n"
    "file; of a log without range images and of scans it runs the stages itself. Live it also\n"
    "sends the picture, bot_core.image_t, on RIMOD_PREVIEW.\n\n"
    "Examples: rimod-view --models models\n"
    "          rimod-view --models models recorded.lcm\n"
    "          rimod-view --models models --output pictures recorded.lcm\n";

constexpr char kFooter[] =
    "Keys: space pause, n next, b back, s save, ? help, q quit; p m h v d e t switch the layers.\n"
    "Exit codes: 0 done; 1 something could not be read or written, or no window; 2 bad usage.";

void AddOptions(CLI::App* app, ViewOptions* options, std::string* layers) {
  app->add_option("source", options->source, "A log or scan file; without it the bus")
      ->type_name("LOG|SCAN");
  app->add_option("--models", options->models,
                  "Folder with the models that are looked for; without it boxes are drawn")
      ->type_name("DIR");
  app->add_option("--output", options->output,
                  "Write a picture of each scan into this folder; no window")
      ->type_name("DIR");
  app->add_option("--save", options->save, "Where the key s saves pictures")
      ->capture_default_str()
      ->type_name("DIR");
  app->add_option("--layers", *layers,
                  "Of points, matched, hypotheses, validated, detections, early, top; or all, none")
      ->capture_default_str()
      ->type_name("NAME,..");
  app->add_option("--interval", options->interval, "How long each scan of a file is shown")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1e6))
      ->type_name("SECONDS");
  app->add_option("--preview-rate", options->preview_rate,
                  "Live: pictures sent a second at most, 0 for none")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 10.0))
      ->type_name("HZ");
  app->add_option("--max-scans", options->max_scans, "--output: no more than so many pictures")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  app->footer(kFooter);
}

}  // namespace

ViewOptionsResult ParseViewOptions(int argc, char** argv) {
  CLI::App app(kDescription, "rimod-view");
  ViewOptions options;
  CommonOptions common;
  BusOptions bus;
  std::string layers = "points,matched,validated,detections,early,top";
  AddCommonOptions(&app, &common);
  AddBusOptions(&app, &bus);
  AddOptions(&app, &options, &layers);
  if (const std::optional<int> exit_code = ParseCommandLine(&app, argc, argv))
    return {std::nullopt, *exit_code};
  LogToStderr(app.get_name());

  const std::optional<Configuration> configuration = LoadConfiguration(common);
  if (!configuration) return {std::nullopt, 2};
  const ChannelsResult channels = ChannelsFrom(bus);
  std::string error = channels.error;
  if (error.empty()) error = SetLayers(layers, &options.layers);
  if (!error.empty()) {
    spdlog::error("{}", error);
    return {std::nullopt, 2};
  }
  options.configuration = *configuration;
  options.channels = *channels.channels;
  options.lcm_url = LcmUrl(bus);
  return {std::move(options), 0};
}

}  // namespace rimod
