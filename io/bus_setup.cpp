#include "io/bus_setup.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace rimod {

std::optional<Configuration> LoadConfiguration(const CommonOptions& common) {
  if (common.config.empty()) return DefaultConfiguration(Method::kDefault);
  ConfigurationResult result = ReadConfiguration(common.config);
  if (!result.configuration) spdlog::error("{}", result.error);
  return std::move(result.configuration);
}

BusSetupResult SetUpBus(const CommonOptions& common, const BusOptions& bus) {
  constexpr int kBadUsage = 2;
  const ChannelsResult channels = ChannelsFrom(bus);
  if (!channels.channels) {
    spdlog::error("{}", channels.error);
    return {std::nullopt, kBadUsage};
  }
  std::optional<Configuration> configuration = LoadConfiguration(common);
  if (!configuration) return {std::nullopt, kBadUsage};
  std::unique_ptr<lcm::LCM> lcm = OpenLcm(LcmUrl(bus));
  if (lcm == nullptr) return {std::nullopt, 1};
  return {BusSetup{*channels.channels, *std::move(configuration), std::move(lcm)}, 0};
}

}  // namespace rimod
