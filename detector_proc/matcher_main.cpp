#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <utility>

#include "detector_proc/matcher_process.h"
#include "detector_proc/shard_options.h"
#include "io/bus.h"
#include "io/bus_setup.h"
#include "io/log_replay.h"
#include "io/model_file.h"
#include "io/process_options.h"
#include "io/thread_pool.h"

int main(int argc, char** argv) {
  const rimod::StopOnSignal signals;
  CLI::App app(
      "Finds known objects in described 3D scans.\n"
      "Reads rimod.range_image_t on RIMOD_RANGE_IMAGE, rimod.feature_set_t on RIMOD_FEATURES and\n"
      "further models, rimod.object_model_t, on RIMOD_MODEL; sends rimod.detections_t on\n"
      "RIMOD_DETECTIONS, rimod.pose_hypotheses_t on RIMOD_HYPOTHESES and rimod.status_t on\n"
      "RIMOD_STATUS once a second. Of sweeps that still go on it tells what it finds on\n"
      "RIMOD_DETECTIONS_EARLY. Of scans that come too fast the newest counts.",
      "rimod-matcher");
  rimod::CommonOptions common;
  rimod::BusOptions bus;
  std::string models;
  int num_threads = 0;
  rimod::AddCommonOptions(&app, &common);
  rimod::AddBusOptions(&app, &bus);
  rimod::ReplayOptions replay;
  rimod::AddReplayOptions(&app, &replay);
  rimod::AddThreadsOption(&app, &num_threads);
  app.add_option("--models", models,
                 "Load every *.rimod file of this folder; without it models come on RIMOD_MODEL")
      ->type_name("DIR");
  rimod::ShardOptions shard;
  rimod::AddShardOptions(&app, &shard);
  if (const auto exit_code = rimod::ParseCommandLine(&app, argc, argv)) return *exit_code;
  rimod::LogToStderr(app.get_name());

  const rimod::BusSetupResult result = rimod::SetUpBus(common, rimod::BusForReplay(bus, replay));
  if (!result.setup) return result.exit_code;
  const auto share = rimod::ShareFrom(shard, result.setup->configuration.pipeline);
  if (!share) return 2;
  rimod::ModelFolder folder;
  if (!models.empty()) {
    rimod::ThreadPool pool(num_threads);
    folder = rimod::LoadModelFolder(models, pool.MakeExecution());
  }
  for (const std::string& error : folder.bad_files) spdlog::error("{}", error);
  if (!folder.error.empty()) {
    spdlog::error("{}", folder.error);
    return 1;
  }
  if (folder.models.empty()) spdlog::warn("no models yet: waiting for some on the model channel");
  lcm::LCM* const lcm = result.setup->lcm.get();
  const rimod::Channels& channels = result.setup->channels;
  rimod::ProcessRun run(replay, lcm,
                        {channels.hypotheses, channels.detections, channels.early_detections,
                         channels.shard_candidates},
                        channels.status);
  rimod::MatcherProcess process(lcm, lcm, channels, result.setup->configuration, num_threads,
                                models, std::move(folder.models), *share, run.tempo());
  return run.Run(signals.stop(), [&process] { process.OnIdle(); });
}
