#include "viewer_tools/report_options.h"

#include <CLI/CLI.hpp>

namespace rimod {
namespace {

constexpr char kDescription[] =
    "Writes one HTML file about a run: what was found, pictures, stage times, and with labels all\n"
    "misses and false alarms, each with a picture and its cause. Causes come from running the\n"
    "detector's stages once more with this configuration.\n\n"
    "Examples: rimod-report --models models --output report.html recorded.lcm\n"
    "          rimod-report --models models --labels labels.json --output report.html logs/*.lcm\n"
    "          rimod-report --models models --labels labels.json --detections found.jsonl\\\n"
    "            --output report.html scan_1.pcd scan_2.pcd\n";

constexpr char kFooter[] =
    "Exit codes: 0 done; 1 something could not be read or written; 2 bad usage.";

void AddInputs(CLI::App* app, ReportOptions* options) {
  app->add_option("--models", options->models, "Folder with the models that were looked for")
      ->required()
      ->type_name("DIR");
  app->add_option("source", options->sources,
                  "Logs with detections and range images, or logs and scan files without: then the "
                  "detections come from --detections, or the detector is run")
      ->required()
      ->type_name("SOURCE...");
  app->add_option("--detections", options->detections, "What rimod-detect printed for the sources")
      ->type_name("FILE.jsonl");
  app->add_option("--timing", options->timing, "What rimod-detect --timing wrote for the sources")
      ->type_name("FILE.json");
  app->add_option("--labels", options->labels, "The objects that truly stand in the scans")
      ->type_name("FILE.json");
  app->add_option("--recordings", options->recordings,
                  "Folder with CLASS/model.json, which tell the objects' symmetries; without, none "
                  "is symmetric")
      ->type_name("DIR");
  app->add_option("--min-visible", options->hits.min_visible,
                  "Objects with a smaller visible share are neither missed nor found")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("SHARE");
  app->add_option("--min-points", options->hits.min_points, "The same for fewer points")
      ->capture_default_str()
      ->check(CLI::Range(0, 1'000'000'000))
      ->type_name("N");
}

}  // namespace

std::unique_ptr<CLI::App> MakeReportApp(ReportCommandLine* command_line) {
  auto app = std::make_unique<CLI::App>(kDescription, "rimod-report");
  ReportOptions& options = command_line->options;
  app->footer(kFooter);
  AddCommonOptions(app.get(), &command_line->common);
  AddThreadsOption(app.get(), &options.num_threads);
  AddInputs(app.get(), &options);
  app->add_option("--output", options.output, "The page to write")
      ->required()
      ->type_name("FILE.html");
  app->add_option("--cases", options.cases,
                  "Also write a picture of each miss and false alarm and a list, cases.jsonl, into "
                  "this folder; made when missing")
      ->type_name("DIR");
  app->add_option("--max-pictures", options.max_pictures,
                  "Scans that get pictures; further ones stand in the tables only")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000000))
      ->type_name("N");
  app->add_option("--max-cases", options.max_cases, "Cases that get pictures, likewise")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000000))
      ->type_name("N");
  app->add_option("--channel", command_line->bus.renamings,
                  "The log has another name for a channel: NAME=OTHER")
      ->allow_extra_args(false)
      ->type_name("NAME=OTHER");
  return app;
}

}  // namespace rimod
