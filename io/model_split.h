#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rimod {

// Which of the models a matcher takes: all, the index-th of count shares, or those of some names.
struct ModelShare {
  int index = 0;  // 1 .. count; 0: not by number
  int count = 0;
  std::vector<std::string> only;  // names; empty: not by name

  bool is_all() const { return count == 0 && only.empty(); }
  // "2/4", or the names with commas between, cut to 200 characters; empty for all.
  std::string Name() const;
};

struct ModelShareResult {
  std::optional<ModelShare> share;
  std::string error;  // empty when there is a share
};
// shard: "INDEX/COUNT", 1 <= INDEX <= COUNT <= kMaxShards, or empty; only: model names. Both given,
// or what is no number or name, is an error.
ModelShareResult ModelShareFrom(const std::string& shard, const std::vector<std::string>& only);

// Tells for models by name whether they belong to a share. Every model belongs to exactly one of
// the shares 1/n .. n/n: the folder's models are dealt out by the order of their names, others
// (which came over the bus, and of which not every matcher may know) by a digest of the name.
class ModelSplit {
 public:
  ModelSplit(ModelShare share, std::vector<std::string> names_of_folder);
  bool Takes(const std::string& name) const;

 private:
  ModelShare share_;
  std::vector<std::string> folder_;  // sorted
};

}  // namespace rimod
