#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "detector_proc/fuser_process.h"
#include "detector_proc/shard_options.h"
#include "io/bus.h"
#include "io/bus_setup.h"
#include "io/process_options.h"

int main(int argc, char** argv) {
  const rimod::StopOnSignal signals;
  CLI::App app(
      "Makes one result of what several rimod-matcher with --shard or --only find: the same as of\n"
      "one matcher with all their models.\n"
      "Reads rimod.shard_t on RIMOD_SHARDS and rimod.shard_candidates_t on "
      "RIMOD_SHARD_CANDIDATES;\n"
      "sends rimod.detections_t on RIMOD_DETECTIONS, rimod.pose_hypotheses_t on RIMOD_HYPOTHESES\n"
      "and rimod.status_t on RIMOD_STATUS once a second. It needs no models, but the matchers'\n"
      "configuration. A shard that is missing costs its models only.",
      "rimod-fuser");
  rimod::CommonOptions common;
  rimod::BusOptions bus;
  rimod::AddCommonOptions(&app, &common);
  rimod::AddBusOptions(&app, &bus);
  if (const auto exit_code = rimod::ParseCommandLine(&app, argc, argv)) return *exit_code;
  rimod::LogToStderr(app.get_name());
  const rimod::BusSetupResult result = rimod::SetUpBus(common, bus);
  if (!result.setup) return result.exit_code;
  const std::string error = rimod::WhyNoShards(result.setup->configuration.pipeline);
  if (!error.empty()) {
    spdlog::error("{}", error);
    return 2;
  }
  lcm::LCM* const lcm = result.setup->lcm.get();
  rimod::FuserProcess process(lcm, lcm, result.setup->channels, result.setup->configuration);
  return rimod::RunBus(lcm, signals.stop(), [&process] { process.OnIdle(); }) ? 0 : 1;
}
