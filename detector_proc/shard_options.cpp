#include "detector_proc/shard_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

namespace rimod {

void AddShardOptions(CLI::App* app, ShardOptions* options) {
  CLI::Option* const shard =
      app->add_option(
             "--shard", options->shard,
             "Be one of several matchers that share the models: take the INDEX-th of COUNT\n"
             "parts of the folder (models are dealt out by name) and send what is found\n"
             "of them, rimod.shard_candidates_t on RIMOD_SHARD_CANDIDATES, to rimod-fuser,\n"
             "which makes the detections. Shards do not look at sweeps that still go on")
          ->type_name("INDEX/COUNT");
  app->add_option("--only", options->only,
                  "The same with the models of these names, e.g. fan,table")
      ->type_name("NAME,..")
      ->delimiter(',')
      ->excludes(shard);
}

std::optional<ModelShare> ShareFrom(const ShardOptions& options, const PipelineParams& params) {
  ModelShareResult result = ModelShareFrom(options.shard, options.only);
  if (result.share && !result.share->is_all()) result.error = WhyNoShards(params);
  if (result.error.empty()) return std::move(result.share);
  spdlog::error("{}", result.error);
  return std::nullopt;
}

std::string WhyNoShards(const PipelineParams& params) {
  if (params.method == Method::kDefault) return "";
  return "with the method 'paper' matchers cannot share the models: its rejection of collisions "
         "compares the points of all models with each other. Use 'method: default', or one matcher "
         "without --shard and --only";
}

}  // namespace rimod
