#include <CLI/CLI.hpp>

#include "io/bus.h"
#include "io/bus_setup.h"
#include "io/log_replay.h"
#include "io/process_options.h"
#include "scanner_proc/assembler_process.h"

int main(int argc, char** argv) {
  const rimod::StopOnSignal signals;
  CLI::App app(
      "Joins the lines of a tilting 2D laser into 3D scans.\n"
      "Reads bot_core.planar_lidar_t on LASER (one line each) and bot_core.rigid_transform_t on\n"
      "LASER_TO_LOCAL (where the laser is); sends rimod.scan_t on RIMOD_SCAN at the end of each "
      "sweep\nof the tilt, its points on RIMOD_SCAN_AHEAD as they come and RIMOD_SCAN_END at its "
      "end, and\nrimod.status_t on RIMOD_STATUS once a second. With --early the growing scans go "
      "out "
      "on\nRIMOD_SCAN_PARTIAL, to be searched for detections before the sweep's end.",
      "rimod-assembler");
  rimod::CommonOptions common;
  rimod::BusOptions bus;
  rimod::AddCommonOptions(&app, &common);
  rimod::AddBusOptions(&app, &bus);
  rimod::ReplayOptions replay;
  rimod::AddReplayOptions(&app, &replay);
  bool early = false;
  app.add_flag("--early", early,
               "Send growing scans, too, every early.period of the configuration: extractor and "
               "matcher then\ntell on RIMOD_DETECTIONS_EARLY what they find before a sweep ends");
  if (const auto exit_code = rimod::ParseCommandLine(&app, argc, argv)) return *exit_code;
  rimod::LogToStderr(app.get_name());

  const rimod::BusSetupResult result = rimod::SetUpBus(common, rimod::BusForReplay(bus, replay));
  if (!result.setup) return result.exit_code;
  lcm::LCM* const lcm = result.setup->lcm.get();
  const rimod::Channels& channels = result.setup->channels;
  rimod::ProcessRun run(
      replay, lcm, {channels.scan, channels.partial_scan, channels.scan_ahead, channels.scan_end},
      channels.status);
  rimod::AssemblerProcess process(lcm, lcm, channels, result.setup->configuration, early,
                                  run.tempo());
  constexpr auto kIdlePeriod =
      std::chrono::milliseconds(5);  // the end of a sweep is seen late by that
  return run.Run(
      signals.stop(), [&process] { process.OnIdle(); }, kIdlePeriod);
}
