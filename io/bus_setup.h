#pragma once

#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <optional>

#include "io/channels.h"
#include "io/config.h"
#include "io/process_options.h"

namespace rimod {

// What a process on the bus starts with.
struct BusSetup {
  Channels channels;
  Configuration configuration;
  std::unique_ptr<lcm::LCM> lcm;
};

struct BusSetupResult {
  std::optional<BusSetup> setup;
  int exit_code = 0;  // where there is no setup; the reason was told on stderr
};

// Channels and configuration as the command line wants them, and LCM. Wrong renamings and
// configurations give exit code 2, an unusable LCM 1.
BusSetupResult SetUpBus(const CommonOptions& common, const BusOptions& bus);

// The configuration of --config, the built-in one without it. Nothing when it cannot be used, which
// was told on stderr.
std::optional<Configuration> LoadConfiguration(const CommonOptions& common);

}  // namespace rimod
