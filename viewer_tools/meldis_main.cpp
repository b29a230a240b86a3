#include <CLI/CLI.hpp>

#include "io/bus.h"
#include "io/bus_setup.h"
#include "io/process_options.h"
#include "viewer_tools/meldis_process.h"

int main(int argc, char** argv) {
  const rimod::StopOnSignal signals;
  CLI::App app(
      "Tells meldis, the viewer of Drake, what the pipeline sees: points coloured by distance and "
      "a\n"
      "box for each object found, in the local frame. Reads what the stages say of a scan; sends\n"
      "drake.lcmt_point_cloud on DRAKE_POINT_CLOUD_RIMOD, drake.lcmt_viewer_load_robot on\n"
      "DRAKE_VIEWER_LOAD_ROBOT and drake.lcmt_viewer_draw on DRAKE_VIEWER_DRAW.\n\n"
      "Example: rimod-meldis & python3 -m pydrake.visualization.meldis -w\n",
      "rimod-meldis");
  rimod::CommonOptions common;
  rimod::BusOptions bus;
  rimod::AddCommonOptions(&app, &common);
  rimod::AddBusOptions(&app, &bus);
  if (const auto exit_code = rimod::ParseCommandLine(&app, argc, argv)) return *exit_code;
  rimod::LogToStderr(app.get_name());
  const rimod::BusSetupResult result = rimod::SetUpBus(common, bus);
  if (!result.setup) return result.exit_code;
  lcm::LCM* const lcm = result.setup->lcm.get();
  rimod::MeldisProcess process(lcm, result.setup->channels, result.setup->configuration.bus);
  return rimod::RunBus(lcm, signals.stop(), [&process] { process.OnIdle(); }) ? 0 : 1;
}
