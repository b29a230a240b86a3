#include "tuning/tune_options.h"

#include <CLI/CLI.hpp>

namespace rimod {
namespace {

constexpr char kDescription[] =
    "Finds better parameters for your sensor and objects from scans of which you say what is in\n"
    "them, tells what they are worth in scans not used for the choice, and writes them as a\n"
    "configuration file for all programs.\n\n"
    "Example: rimod-tune --recordings recordings --labels labels.json --out best.yaml *.lcm\n";

constexpr char kFooter[] =
    "Ctrl-C writes the best so far. With --trials the result depends on the input and the seed\n"
    "alone (and on the machine with --max-ms). docs/tuning.md has more.\n"
    "Exit codes: 0 done; 1 an input could not be used or an output not written; 2 bad usage.";

void SetBudget(const std::string& text, TuneOptions* options) {
  const std::optional<double> seconds = SecondsFrom(text);
  if (!seconds) throw CLI::ValidationError("--budget", "'" + text + "' is not like 90s, 20min, 2h");
  options->budget = *seconds;
}

void AddInputs(CLI::App* app, TuneOptions* options) {
  auto* const recordings =
      app->add_option("--recordings", options->recordings,
                      "Recordings of the objects: a folder of folders with model.json and "
                      "scan_*.pcd each");
  recordings->type_name("DIR");
  app->add_option("--models", options->models,
                  "Finished models (*.rimod) instead: their surfaces are then not varied")
      ->type_name("DIR")
      ->excludes(recordings);
  app->add_option("--labels", options->labels, "What stands where in the scans (JSON)")
      ->type_name("FILE.json");
  app->add_option("scan", options->scans, "Scans: logs of lcm-logger, .pcd, .ply, 3DTK .3d")
      ->type_name("SCAN...");
}

void AddSearch(CLI::App* app, TuneOptions* options) {
  app->add_option("--vary", options->vary,
                  "A parameter to vary: KEY=LOW..HIGH, KEY=A,B,C, or KEY for half to twice its "
                  "value; may be given several times. Without any a short list of the method's "
                  "(docs/tuning.md)")
      ->type_name("KEY=RANGE")
      ->take_all();
  app->add_flag("--list", options->list, "Print the parameters that may be varied and exit");
  app->add_option("--objective", options->objective,
                  "What to make large: f1 (default), f0.5 (false alarms weigh more), f2 (misses "
                  "weigh more), pose-f1 (a wrong pose is a miss and a false alarm), zeta (the "
                  "paper's), recall@0.95 (recall where the precision is at least that)")
      ->type_name("NAME");
  app->add_option("--max-ms", options->max_ms,
                  "Parameters that take more processor time a scan in the mean are never best")
      ->check(CLI::Range(0.0, 1e6))
      ->type_name("MS");
  auto* const budget = app->add_option_function<std::string>(
      "--budget", [options](const std::string& text) { SetBudget(text, options); },
      "Time to search, by default 10min");
  budget->type_name("TIME");
  app->add_option("--trials", options->num_trials,
                  "Look at this many settings in each search instead: for results that repeat")
      ->check(CLI::Range(1, 1000000))
      ->excludes(budget)
      ->type_name("N");
  app->add_option("--folds", options->num_folds, "Parts for cross-validation, by default 3")
      ->check(CLI::Range(2, 20))
      ->type_name("N");
  app->add_option("--seed", options->seed, "Another seed looks at other settings")->type_name("S");
}

}  // namespace

std::unique_ptr<CLI::App> MakeTuneApp(TuneCommandLine* command_line) {
  auto app = std::make_unique<CLI::App>(kDescription, "rimod-tune");
  TuneOptions& options = command_line->options;
  app->footer(kFooter);
  AddCommonOptions(app.get(), &command_line->common);
  AddThreadsOption(app.get(), &options.num_threads);
  AddInputs(app.get(), &options);
  AddCloudOptions(app.get(), &options.clouds);
  AddSearch(app.get(), &options);
  app->add_option("--out", options.out, "The configuration file to write")->type_name("FILE.yaml");
  app->add_option("--csv", options.csv, "Write a table of all settings tried")
      ->type_name("FILE.csv");
  app->add_flag("--even-if-unclear", options.even_if_unclear,
                "Write the parameters found even if their gain may be chance");
  app->final_callback([&options] {
    if (options.list) return;
    if (options.recordings.empty() && options.models.empty())
      throw CLI::RequiredError("--recordings or --models");
    if (options.labels.empty()) throw CLI::RequiredError("--labels");
    if (options.scans.empty()) throw CLI::RequiredError("SCAN");
  });
  return app;
}

}  // namespace rimod
