#include <CLI/CLI.hpp>

#include "detector_proc/extractor_process.h"
#include "io/bus.h"
#include "io/bus_setup.h"
#include "io/log_replay.h"
#include "io/process_options.h"

int main(int argc, char** argv) {
  const rimod::StopOnSignal signals;
  CLI::App app(
      "Describes 3D scans: computes their range images and the features in them.\n"
      "Reads rimod.scan_t on RIMOD_SCAN; sends rimod.range_image_t on RIMOD_RANGE_IMAGE,\n"
      "rimod.feature_set_t on RIMOD_FEATURES and rimod.status_t on RIMOD_STATUS once a second.\n"
      "While there is nothing else to do it describes growing scans, too, from "
      "RIMOD_SCAN_PARTIAL.\n"
      "With --cloud-channel scans also come as bot_core.pointcloud2_t, from a sensor that delivers "
      "whole ones.\n"
      "Scans that come faster than they can be described overtake each other: the newest counts.",
      "rimod-extractor");
  rimod::CommonOptions common;
  rimod::BusOptions bus;
  int num_threads = 0;
  rimod::AddCommonOptions(&app, &common);
  rimod::AddBusOptions(&app, &bus);
  rimod::ReplayOptions replay;
  rimod::AddReplayOptions(&app, &replay);
  rimod::AddThreadsOption(&app, &num_threads);
  rimod::CloudChannels clouds;
  rimod::AddCloudOptions(&app, &clouds);
  if (const auto exit_code = rimod::ParseCommandLine(&app, argc, argv)) return *exit_code;
  rimod::LogToStderr(app.get_name());

  const rimod::BusSetupResult result = rimod::SetUpBus(common, rimod::BusForReplay(bus, replay));
  if (!result.setup) return result.exit_code;
  lcm::LCM* const lcm = result.setup->lcm.get();
  const rimod::Channels& channels = result.setup->channels;
  rimod::ProcessRun run(replay, lcm,
                        {channels.range_image, channels.features, channels.partial_range_image,
                         channels.partial_features},
                        channels.status);
  rimod::ExtractorProcess process(lcm, lcm, channels, result.setup->configuration, num_threads,
                                  clouds, run.tempo());
  return run.Run(signals.stop(), [&process] { process.OnIdle(); });
}
