#include "detector_proc/detect_options.h"

#include <CLI/CLI.hpp>
#include <iostream>

namespace rimod {
namespace {

constexpr char kDescription[] =
    "Finds known objects in 3D laser scans: prints one line of JSON on stdout for each, with its\n"
    "class, pose (tx, ty, tz in metres, then the quaternion w, x, y, z: object to scan frame) and\n"
    "score (0 .. 1). Everything else goes to stderr.\n\n"
    "Example: rimod-detect --models models office.pcd recorded.lcm\n";

constexpr char kFooter[] =
    "Exit codes: 0 done, also when nothing was found; 1 some input could not be read (it is "
    "named,\n"
    "the rest is done); 2 bad usage or configuration.";

void PrintConfiguration(const std::string& method) {
  const Method base = method == "paper" ? Method::kPaper : Method::kDefault;
  std::cout << DumpConfiguration(DefaultConfiguration(base));
  throw CLI::Success();
}

}  // namespace

std::unique_ptr<CLI::App> MakeDetectApp(DetectCommandLine* command_line) {
  auto app = std::make_unique<CLI::App>(kDescription, "rimod-detect");
  DetectOptions& options = command_line->options;
  app->footer(kFooter);
  AddCommonOptions(app.get(), &command_line->common);
  AddThreadsOption(app.get(), &options.num_threads);
  app->add_option("--models", options.models, "Folder with the models: all of its *.rimod")
      ->type_name("DIR")
      ->required();
  AddCloudOptions(app.get(), &options.clouds);
  app->add_option("--timing", options.timing,
                  "Write the milliseconds of every stage of every scan there")
      ->type_name("FILE.json");
  app->add_option_function<std::string>("--print-config", &PrintConfiguration,
                                        "Print all parameters of a method (paper or default) as a "
                                        "configuration file and exit")
      ->type_name("METHOD")
      ->check(CLI::IsMember({"paper", "default"}));
  app->add_option("scan", options.scans,
                  "Scans: .pcd, .ply, 3DTK .3d, or logs of lcm-logger, of which every sweep is a "
                  "scan")
      ->type_name("SCAN...")
      ->required();
  return app;
}

}  // namespace rimod
