#include "scanner_proc/simulator_process.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <lcm/lcm-cpp.hpp>

#include "io/config.h"
#include "scanner_proc/live_scanner.h"
#include "scanner_proc/scene_file.h"

namespace rimod::simulation {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kBadUsage = 2;

}  // namespace

void AddSimulatorOptions(CLI::App* app, SimulatorOptions* options) {
  app->add_option("SCENE", options->scene, "Scene file (YAML); docs/simulator.md has its keys")
      ->required()
      ->type_name("SCENE.yaml");
  app->add_option("--log", options->files.log,
                  "Write an LCM log instead of publishing; the same scene gives the same bytes")
      ->type_name("FILE");
  app->add_option("--pcd", options->files.pcd,
                  "Write the assembled cloud (several sweeps: NAME#0.pcd, NAME#1.pcd, ..)")
      ->type_name("FILE.pcd");
  app->add_option("--truth", options->files.truth,
                  "Write which objects of a class stand where and how much of them was seen (JSON)")
      ->type_name("FILE.json");
  app->add_option(
         "--recording", options->recording,
         "Carry the sensor round the scene's only object of a class and write a folder for "
         "rimod-modeler --recording")
      ->type_name("DIR");
  app->add_option("--views", options->num_views, "Viewpoints of a recording, evenly spread")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  app->add_option("--speed", options->speed,
                  "Publish so many times faster than real time; 0: as fast as receivers follow")
      ->type_name("FACTOR")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  app->add_option("--repeat", options->num_sweeps,
                  "Sweeps, down and up in turn; 0: until stopped (not into files)")
      ->type_name("N")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  app->add_option("--seed", options->seed, "Seed of the noise instead of the scene's")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{9000000000000000}));
  app->footer(
      "Without --log, --pcd, --truth or --recording it publishes the lines (LASER) and poses\n"
      "(LASER_TO_LOCAL) of the simulated scanner, as a real one would.\n"
      "Exit codes: 0 done, 1 something could not be read or written, 2 bad usage.");
  AddCommonOptions(app, &options->common);
  AddBusOptions(app, &options->bus);
}

std::string SimulatorProcess::CheckOptions() const {
  const bool offline = options_.files.any();
  if (!options_.recording.empty() && offline) {
    return "--recording goes without --log, --pcd and --truth";
  }
  if (options_.num_views && options_.recording.empty()) return "--views needs --recording";
  if (options_.num_sweeps == 0 && offline) return "--repeat 0 would fill the disk: not into files";
  return "";
}

int SimulatorProcess::Run(const std::atomic<bool>& stop) {
  const ChannelsResult channels = ChannelsFrom(options_.bus);
  const std::string bad_usage = channels.channels ? CheckOptions() : channels.error;
  if (!bad_usage.empty()) {
    spdlog::error(bad_usage);
    return kBadUsage;
  }
  channels_ = *channels.channels;
  Configuration configuration = DefaultConfiguration(Method::kDefault);
  if (!options_.common.config.empty()) {
    const ConfigurationResult result = ReadConfiguration(options_.common.config);
    if (!result.configuration) {
      spdlog::error(result.error);
      return kFailed;
    }
    configuration = *result.configuration;
  }
  SceneResult scene = ReadScene(options_.scene);
  if (!scene.scene) {
    spdlog::error(scene.error);
    return kFailed;
  }
  scene_ = std::move(*scene.scene);
  if (options_.seed) scene_.seed = static_cast<std::uint64_t>(*options_.seed);
  if (options_.num_views) scene_.recording.num_views = *options_.num_views;
  try {
    const bool live = !options_.files.any() && options_.recording.empty();
    return live ? RunLive(stop) : RunOffline(configuration.pipeline.sweep, stop);
  } catch (const std::exception& error) {
    spdlog::error("{}: {}", options_.scene, error.what());
    return kFailed;
  }
}

int SimulatorProcess::RunOffline(const SweepParams& params, const std::atomic<bool>& stop) const {
  const SweepParams sensor_params = SweepParamsFor(scene_.sensor, params);
  if (!options_.recording.empty()) {
    const std::string error = WriteRecording(scene_, sensor_params, options_.recording, stop);
    if (!error.empty()) spdlog::error("{}: {}", options_.scene, error);
    return error.empty() ? kDone : kFailed;
  }
  const SweepFilesResult result =
      WriteSweeps(scene_, options_.num_sweeps, channels_, sensor_params, options_.files, stop);
  for (const std::string& error : result.errors) spdlog::error(error);
  if (result.stopped) {
    spdlog::warn("stopped: log and truth were not written");
    return kFailed;
  }
  std::size_t num_points = 0;
  for (const std::size_t number : result.num_points) num_points += number;
  spdlog::info("{}: {} sweeps, {} lines, {} points", scene_.name, result.num_points.size(),
               result.num_lines, num_points);
  return result.errors.empty() ? kDone : kFailed;
}

int SimulatorProcess::RunLive(const std::atomic<bool>& stop) const {
  const std::unique_ptr<lcm::LCM> lcm = OpenLcm(LcmUrl(options_.bus));
  if (!lcm) return kFailed;
  const LiveResult result =
      PublishSweeps(scene_, options_.num_sweeps, options_.speed, channels_, lcm.get(), stop);
  spdlog::info("{}: {} lines published{}", scene_.name, result.num_lines,
               result.num_late > 0 ? ", " + std::to_string(result.num_late) + " of them late" : "");
  if (result.num_failed > 0) spdlog::error("{} messages could not be sent", result.num_failed);
  return result.num_failed > 0 ? kFailed : kDone;
}

}  // namespace rimod::simulation
