#include "io/model_split.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "io/numbers.h"
#include "io/shard_messages.h"
#include "rimod/object_model.h"

namespace rimod {
namespace {

constexpr std::size_t kMaxName = 200;

std::uint64_t DigestOf(const std::string& name) {  // FNV-1a
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : name) hash = (hash ^ static_cast<std::uint8_t>(c)) * 1099511628211u;
  return hash;
}

// -1 where it is none, or absurd.
int Number(const std::string& text) {
  constexpr std::int64_t kAbsurd = 1'000'000;
  const std::optional<std::int64_t> number = ParseCount(text);
  return number && *number < kAbsurd ? static_cast<int>(*number) : -1;
}

}  // namespace

std::string ModelShare::Name() const {
  if (count > 0) return std::to_string(index) + "/" + std::to_string(count);
  std::string name;
  for (const std::string& model : only) name += (name.empty() ? "" : ",") + model;
  return name.substr(0, kMaxName);
}

ModelShareResult ModelShareFrom(const std::string& shard, const std::vector<std::string>& only) {
  if (!shard.empty() && !only.empty())
    return {std::nullopt, "a matcher takes its models by number or by name, not both"};
  ModelShare share;
  for (const std::string& name : only) {
    if (!IsValidModelName(name)) return {std::nullopt, "'" + name + "' cannot be a model's name"};
  }
  share.only = only;
  if (shard.empty()) return {std::move(share), ""};
  const std::size_t slash = shard.find('/');
  if (slash != std::string::npos) {
    share.index = Number(shard.substr(0, slash));
    share.count = Number(shard.substr(slash + 1));
  }
  if (share.index < 1 || share.count < share.index || share.count > kMaxShards) {
    return {std::nullopt, "'" + shard + "' is not INDEX/COUNT such as 2/4, with at most " +
                              std::to_string(kMaxShards) + " shards"};
  }
  return {std::move(share), ""};
}

ModelSplit::ModelSplit(ModelShare share, std::vector<std::string> names_of_folder)
    : share_(std::move(share)), folder_(std::move(names_of_folder)) {
  std::sort(folder_.begin(), folder_.end());
}

bool ModelSplit::Takes(const std::string& name) const {
  if (share_.is_all()) return true;
  if (share_.count == 0)
    return std::find(share_.only.begin(), share_.only.end(), name) != share_.only.end();
  const auto place = std::lower_bound(folder_.begin(), folder_.end(), name);
  const bool in_folder = place != folder_.end() && *place == name;
  const std::uint64_t number =
      in_folder ? static_cast<std::uint64_t>(place - folder_.begin()) : DigestOf(name);
  return number % static_cast<std::uint64_t>(share_.count) ==
         static_cast<std::uint64_t>(share_.index - 1);
}

}  // namespace rimod
