#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/model_split.h"
#include "rimod/params.h"

namespace CLI {
class App;
}

namespace rimod {

// Which models a matcher takes, as the command line says it.
struct ShardOptions {
  std::string shard;              // INDEX/COUNT or empty
  std::vector<std::string> only;  // names
};

// Adds --shard and --only.
void AddShardOptions(CLI::App* app, ShardOptions* options);

// Nothing, told on stderr, where the options are wrong or the method is not one for shards.
std::optional<ModelShare> ShareFrom(const ShardOptions& options, const PipelineParams& params);

// Why matchers cannot share the models with these parameters; empty when they can.
std::string WhyNoShards(const PipelineParams& params);

}  // namespace rimod
