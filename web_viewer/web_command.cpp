#include "web_viewer/web_command.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "io/bus.h"
#include "io/bus_setup.h"
#include "io/files.h"
#include "io/model_file.h"
#include "io/version.h"
#include "web_viewer/log_player.h"
#include "web_viewer/web_process.h"

namespace rimod {
namespace {

constexpr char kDescription[] =
    "Serves a page that shows the pipeline in 3D: the live scan, found objects, hypotheses, the\n"
    "sensor, and the scans before. Reads rimod.scan_t on RIMOD_SCAN (or rimod.range_image_t on\n"
    "RIMOD_RANGE_IMAGE), rimod.detections_t on RIMOD_DETECTIONS, rimod.pose_hypotheses_t on\n"
    "RIMOD_HYPOTHESES and rimod.early_detections_t on RIMOD_DETECTIONS_EARLY, or all of these from "
    "a\n"
    "log of lcm-logger. Of a log with laser lines but without detections it finds them itself.\n\n"
    "Examples: rimod-web --models models\n"
    "          rimod-web --models models recorded.lcm\n";

constexpr char kFooter[] =
    "Then open http://127.0.0.1:8086/ in a browser. From another machine: ssh -L "
    "8086:localhost:8086 "
    "HOST.\nExit codes: 0 done; 1 the page, the port, the log or the bus cannot be used; 2 bad "
    "usage.";

void AddServerOptions(CLI::App* app, WebServerOptions* server) {
  app->add_option("--port", server->port, "TCP port of the page; 0 for any that is free")
      ->check(CLI::Range(0, 65535))
      ->type_name("N")
      ->capture_default_str();
  app->add_option("--address", server->address,
                  "Of the interface to listen on; others than this machine's own let everybody on "
                  "that network look, and move the log")
      ->type_name("IP")
      ->capture_default_str();
  app->add_option("--host-name", server->host_names,
                  "A name that pages may call the server by, beside localhost; repeatable")
      ->allow_extra_args(false)
      ->type_name("NAME");
  app->add_option("--max-clients", server->max_clients, "Pages at a time")
      ->check(CLI::Range(1, 1000))
      ->type_name("N")
      ->capture_default_str();
}

// What the page is made of, or why it cannot be had.
PageFiles LoadPage(const std::string& folder) {
  const std::filesystem::path beside =
      std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "share" /
      "rimod-web";
  PageFiles page = LoadPageFiles(folder.empty() ? beside.string() : folder);
  if (!page.error.empty() && folder.empty())
    page.error +=
        ": the page was not built, which needs npm and, once, the npm registry "
        "(./setup.sh --web); then build again";
  return page;
}

// Models for the page and for the detector.
struct LoadedModels {
  std::map<std::string, Frame> frames;
  std::vector<ObjectModel> models;
  std::string error;
};
LoadedModels LoadModels(const std::string& folder, int num_threads) {
  if (folder.empty()) return {};
  ThreadPool pool(num_threads);
  LoadedModels loaded;
  ModelFolder read = LoadModelFolder(folder, pool.MakeExecution());
  for (const std::string& error : read.bad_files) spdlog::error("{}", error);
  for (const ObjectModel& model : read.models) loaded.frames[model.name] = ModelFrame(model);
  loaded.models = std::move(read.models);
  loaded.error = read.error;
  return loaded;
}

std::string HelloJson(const WebOptions& options, const std::map<std::string, Frame>& models) {
  using Json = nlohmann::ordered_json;
  Json names = Json::array();
  for (const auto& [name, frame] : models) names.push_back(name);
  const Json hello = {{"type", "hello"},
                      {"version", Version()},
                      {"source", options.log.empty() ? "live" : "log"},
                      {"log", FileStem(options.log)},
                      {"models", std::move(names)}};
  return hello.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void TellAddress(const WebServerOptions& options, const WebServer& server) {
  spdlog::info("the page is on http://{}:{}/", options.address, server.port());
}

int ServeLive(const WebOptions& options, PageFiles page, WebContent* content) {
  const StopOnSignal signal;
  const BusSetupResult bus = SetUpBus(options.common, options.bus);
  if (!bus.setup) return bus.exit_code;
  const WebServer server(options.server, std::move(page), content, {});
  TellAddress(options.server, server);
  lcm::LCM* const lcm = bus.setup->lcm.get();
  WebProcess process(lcm, lcm, bus.setup->channels, bus.setup->configuration, content, &server);
  return RunBus(lcm, signal.stop(), [&process] { process.OnIdle(); }) ? 0 : 1;
}

// The detector that a log without detections needs.
std::unique_ptr<ScanDetector> DetectorFor(const LogSummary& log, const Configuration& configuration,
                                          std::vector<ObjectModel> models, int num_threads) {
  if (log.has_detections || !log.has_lines || models.empty()) return nullptr;
  return std::make_unique<ScanDetector>(std::move(models), configuration.pipeline, num_threads);
}

int ServeLog(const WebOptions& options, PageFiles page, std::vector<ObjectModel> models,
             WebContent* content) {
  const StopOnSignal signal;
  const ChannelsResult channels = ChannelsFrom(options.bus);
  if (!channels.channels) {
    spdlog::error("{}", channels.error);
    return 2;
  }
  const std::optional<Configuration> configuration = LoadConfiguration(options.common);
  if (!configuration) return 2;
  const LogSummary log = SummariseLog(options.log, *channels.channels);
  if (!log.error.empty()) spdlog::error("{}", log.error);
  if (!log.can_be_shown()) {
    spdlog::error("{}: nothing that can be shown: no scans, laser lines or detections",
                  options.log);
    return 1;
  }
  std::unique_ptr<ScanDetector> detector =
      DetectorFor(log, *configuration, std::move(models), options.num_threads);
  std::optional<LogPlayer> player;  // of this life: the server tells it before and after
  std::mutex player_mutex;
  const auto on_command = [&](const ClientRequest& request) {
    const std::lock_guard<std::mutex> lock(player_mutex);
    if (player) player->Take(request);
  };
  const WebServer server(options.server, std::move(page), content, on_command);
  TellAddress(options.server, server);
  {
    const std::lock_guard<std::mutex> lock(player_mutex);
    player.emplace(LogPlayerOptions{options.log, *channels.channels, *configuration, options.speed},
                   log, std::move(detector), content);
  }
  while (!signal.stop()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const std::lock_guard<std::mutex> lock(player_mutex);
  player.reset();
  return 0;
}

}  // namespace

std::unique_ptr<CLI::App> MakeWebApp(WebOptions* options) {
  auto app = std::make_unique<CLI::App>(kDescription, "rimod-web");
  app->footer(kFooter);
  AddCommonOptions(app.get(), &options->common);
  AddBusOptions(app.get(), &options->bus);
  AddThreadsOption(app.get(), &options->num_threads);
  app->add_option("log,--log", options->log, "A log of lcm-logger; without it the bus")
      ->type_name("LOG");
  app->add_option("--speed", options->speed, "Log: so many times as fast as recorded")
      ->check(CLI::Range(0.01, kMaxSpeed))
      ->type_name("N")
      ->capture_default_str();
  app->add_option("--models", options->models,
                  "Folder with the models (*.rimod) whose surfaces are drawn; objects without one "
                  "are drawn as boxes")
      ->type_name("DIR");
  AddServerOptions(app.get(), &options->server);
  app->add_option("--scans", options->history.max_scans, "Scans of the past that are kept")
      ->check(CLI::Range(1, 100000))
      ->type_name("N")
      ->capture_default_str();
  app->add_option("--megabytes", options->history.max_bytes, "Memory that they may take")
      ->check(CLI::Range(1, 1000000))
      ->transform([](const std::string& megabytes) { return megabytes + "000000"; })
      ->type_name("N")
      ->default_str("256");
  app->add_option("--page", options->page, "Folder with the page, where it is not the built one")
      ->type_name("DIR");
  return app;
}

int RunWeb(const WebOptions& options) {
  PageFiles page = LoadPage(options.page);
  if (!page.error.empty()) {
    spdlog::error("{}", page.error);
    return 1;
  }
  LoadedModels models = LoadModels(options.models, options.num_threads);
  if (!models.error.empty()) {
    spdlog::error("{}", models.error);
    return 1;
  }
  const std::string hello = HelloJson(options, models.frames);
  WebContent content(hello, std::move(models.frames), options.history);
  return options.log.empty()
             ? ServeLive(options, std::move(page), &content)
             : ServeLog(options, std::move(page), std::move(models.models), &content);
}

}  // namespace rimod
