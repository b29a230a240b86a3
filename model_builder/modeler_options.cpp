#include "model_builder/modeler_options.h"

#include <CLI/CLI.hpp>

namespace rimod {
namespace {

constexpr char kDescription[] =
    "Builds the model of an object, which rimod-detect and rimod-matcher then find in scans.\n\n"
    "Examples: rimod-modeler --recording fan --out models/fan.rimod\n"
    "          rimod-modeler --mesh chair.obj --class chair --out models/chair.rimod\n"
    "          rimod-modeler --inspect models/chair.rimod --output chair.png\n";

constexpr char kFooter[] =
    "Object frame: origin at the middle of the bounding box's bottom, z up, metres.\n"
    "Exit codes: 0 done; 1 the input could not be used or the model not written; 2 bad usage.";

}  // namespace

std::unique_ptr<CLI::App> MakeModelerApp(ModelerCommandLine* command_line) {
  auto app = std::make_unique<CLI::App>(kDescription, "rimod-modeler");
  ModelerOptions& options = command_line->options;
  app->footer(kFooter);
  AddCommonOptions(app.get(), &command_line->common);
  AddBusOptions(app.get(), &options.bus);
  AddThreadsOption(app.get(), &options.num_threads);
  CLI::Option_group* const source = app->add_option_group("Source", "What the model is built from");
  source
      ->add_option("--recording", options.recording,
                   "Scans round the object: a folder with model.json and scan_*.pcd")
      ->type_name("DIR");
  source
      ->add_option("--live", options.live,
                   "Record scans from RIMOD_SCAN into a folder that holds model.json alone (class, "
                   "pose and box of the object in the scans' local frame), then build from them; "
                   "Ctrl-C ends the recording before --scans have come")
      ->type_name("DIR");
  source
      ->add_option("--cloud", options.cloud,
                   "Points of the object alone, in its object frame; a model.json beside it may "
                   "name the class")
      ->type_name("FILE.ply|pcd");
  source->add_option("--mesh", options.mesh, "The object's surface, in its object frame")
      ->type_name("FILE.obj|ply|stl");
  source
      ->add_option("--inspect", options.inspect,
                   "Build nothing: draw this model's surface, views, features and validation "
                   "points into the picture --output")
      ->type_name("FILE.rimod");
  source->require_option(1);
  app->add_option("--output", options.output, "The picture of an inspected model")
      ->type_name("FILE.png");
  app->add_option("--scans", options.num_live_scans,
                  "Scans that a live recording takes, by default 8")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  app->add_option("--class", options.class_name, "Name of the object's class")->type_name("NAME");
  app->add_option("--out", options.out, "The model file to write")->type_name("FILE.rimod");
  app->add_flag("--publish", options.publish,
                "Send the finished model on RIMOD_MODEL too: running matchers take it in");
  app->final_callback([&options] {
    if (options.inspect.empty() && options.out.empty()) throw CLI::RequiredError("--out");
    if (!options.inspect.empty() && options.output.empty()) throw CLI::RequiredError("--output");
  });
  return app;
}

}  // namespace rimod
