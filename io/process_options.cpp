#include "io/process_options.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <lcm/lcm-cpp.hpp>

#include "io/version.h"

namespace rimod {

void AddCommonOptions(CLI::App* app, CommonOptions* options) {
  app->set_version_flag("--version", app->get_name() + " " + Version(),
                        "Print the version and exit");
  app->add_option("--config", options->config,
                  "Configuration file (YAML); what it does not set keeps its built-in value")
      ->type_name("FILE.yaml");
}

void AddBusOptions(CLI::App* app, BusOptions* options) {
  app->add_option("-l,--lcm-url", options->lcm_url,
                  std::string("Where to speak LCM; without it the environment's LCM_DEFAULT_URL, "
                              "else ") +
                      kDefaultLcmUrl)
      ->type_name("URL");
  std::string names;
  for (const std::string& name : DefaultChannelNames()) names += " " + name;
  app->add_option("--channel", options->renamings,
                  "Use another name for a channel, e.g. RIMOD_SCAN=OTHER; may be repeated. "
                  "Channels:" +
                      names)
      ->type_name("NAME=OTHER")
      ->allow_extra_args(false);
}

void AddThreadsOption(CLI::App* app, int* num_threads) {
  app->add_option(
         "--threads", *num_threads,
         "Threads that compute; 0: as many as the machine has. Results do not depend on it")
      ->check(CLI::Range(0, 256))
      ->type_name("N");
}

void AddCloudOptions(CLI::App* app, CloudChannels* channels) {
  const auto usable = [](const std::string& name) {
    return IsUsableChannelName(name)
               ? std::string()
               : "'" + name + "' cannot be a channel name: 1 to 63 printable characters, no spaces";
  };
  CLI::Option* const clouds =
      app->add_option(
             "--cloud-channel", channels->clouds,
             "Scans come there, too, as bot_core.pointcloud2_t, a whole scan each, in the "
             "sensor's frame;\nwhere the sensor is mounted says the configuration's section "
             "cloud")
          ->type_name("NAME")
          ->check(usable);
  app->add_option("--cloud-pose-channel", channels->poses,
                  "Poses of the clouds' carrier, bot_core.rigid_transform_t, carrier to local "
                  "frame;\nwithout it the carrier stands at the local frame's origin")
      ->type_name("NAME")
      ->check(usable)
      ->needs(clouds);
}

std::optional<int> ParseCommandLine(CLI::App* app, int argc, char** argv) {
  constexpr int kBadUsage = 2;
  try {
    app->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app->exit(error) == 0 ? CheckStdout(0) : kBadUsage;
  }
  return std::nullopt;
}

int CheckStdout(int exit_code) {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return exit_code;
  std::fprintf(stderr, "stdout: writing failed: %s\n", std::strerror(errno));
  return 1;
}

void LogToStderr(const std::string& executable) {
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      executable, std::make_shared<spdlog::sinks::stderr_color_sink_mt>()));
  spdlog::set_pattern("%H:%M:%S.%e %n %^%l%$: %v");
}

ChannelsResult ChannelsFrom(const BusOptions& options) {
  Channels channels;
  for (const std::string& renaming : options.renamings) {
    std::string error = RenameChannel(renaming, &channels);
    if (!error.empty()) return {std::nullopt, "--channel: " + error};
  }
  return {std::move(channels), ""};
}

std::string LcmUrl(const BusOptions& options) {
  if (!options.lcm_url.empty()) return options.lcm_url;
  const char* const environment = std::getenv("LCM_DEFAULT_URL");
  if (environment != nullptr && *environment != '\0') return environment;
  return kDefaultLcmUrl;
}

std::unique_ptr<lcm::LCM> OpenLcm(const std::string& url) {
  auto lcm = std::make_unique<lcm::LCM>(url);
  if (lcm->good()) return lcm;
  spdlog::error("LCM cannot be used at '{}'", url);
  spdlog::error(
      "Most often there is no route for multicast. Join a network, or keep to this machine:\n"
      "    sudo ip link set lo multicast on\n"
      "    sudo ip route add 224.0.0.0/4 dev lo");
  spdlog::error("Else look at --lcm-url and LCM_DEFAULT_URL: udpm://239.255.76.67:7667?ttl=0");
  return nullptr;
}

}  // namespace rimod
