#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/channels.h"

namespace CLI {
class App;
}

namespace lcm {
class LCM;
}

namespace rimod {

// The options that all executables share.
struct CommonOptions {
  std::string config;  // path; empty: the built-in values
};

// The options of the executables on the bus.
struct BusOptions {
  std::string lcm_url;                 // empty: not given
  std::vector<std::string> renamings;  // NAME=OTHER
};

// Adds --version (prints "NAME VERSION" on stdout) and --config; --help is CLI11's own.
void AddCommonOptions(CLI::App* app, CommonOptions* options);

// Adds -l, --lcm-url and --channel.
void AddBusOptions(CLI::App* app, BusOptions* options);

// Adds --threads: 0, the default, for as many as the machine has.
void AddThreadsOption(CLI::App* app, int* num_threads);

// Adds --cloud-channel and --cloud-pose-channel.
void AddCloudOptions(CLI::App* app, CloudChannels* channels);

// Parses the command line. A value is an exit code: 0 after --help or --version, 2 for bad usage
// (told on stderr); without one the program goes on.
std::optional<int> ParseCommandLine(CLI::App* app, int argc, char** argv);

// The exit code of a program that wrote its results to stdout: 1, told on stderr, where they could
// not be written (a full disk, a closed pipe), else as given.
int CheckStdout(int exit_code);

// Sends messages of spdlog to stderr, each with time and the executable's name.
void LogToStderr(const std::string& executable);

// The channels after all renamings, or an error text.
struct ChannelsResult {
  std::optional<Channels> channels;
  std::string error;
};
ChannelsResult ChannelsFrom(const BusOptions& options);

// LCM's default group with a receive buffer that takes a burst of large messages.
constexpr char kDefaultLcmUrl[] = "udpm://239.255.76.67:7667?recv_buf_size=4194304";

// --lcm-url, else the environment's LCM_DEFAULT_URL, else kDefaultLcmUrl.
std::string LcmUrl(const BusOptions& options);

// Joins the bus. Where that is not possible (no multicast route, malformed URL) says so and what to
// do on stderr and returns null: exit code 1.
std::unique_ptr<lcm::LCM> OpenLcm(const std::string& url);

}  // namespace rimod
