#include "io/channels.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace rimod {
namespace {

constexpr std::size_t kMaxChannelLength = 63;  // LCM's own limit

constexpr std::array<std::string Channels::*, 20> kNames = {&Channels::laser,
                                                            &Channels::laser_to_local,
                                                            &Channels::scan,
                                                            &Channels::range_image,
                                                            &Channels::features,
                                                            &Channels::model,
                                                            &Channels::hypotheses,
                                                            &Channels::detections,
                                                            &Channels::scan_ahead,
                                                            &Channels::scan_end,
                                                            &Channels::partial_scan,
                                                            &Channels::partial_range_image,
                                                            &Channels::partial_features,
                                                            &Channels::early_detections,
                                                            &Channels::shards,
                                                            &Channels::shard_candidates,
                                                            &Channels::shard_scans,
                                                            &Channels::shard_turns,
                                                            &Channels::status,
                                                            &Channels::preview};

}  // namespace

bool IsUsableChannelName(const std::string& name) {
  return !name.empty() && name.size() <= kMaxChannelLength &&
         std::all_of(name.begin(), name.end(),
                     [](char c) { return std::isgraph(static_cast<unsigned char>(c)) != 0; });
}

std::string RenameChannel(const std::string& renaming, Channels* channels) {
  const std::size_t equals = renaming.find('=');
  if (equals == std::string::npos) {
    return "'" + renaming + "' is not of the form NAME=OTHER";
  }
  const std::string from = renaming.substr(0, equals);
  const std::string to = renaming.substr(equals + 1);
  const Channels defaults;
  for (std::string Channels::*const name : kNames) {
    if (defaults.*name != from) continue;
    if (!IsUsableChannelName(to)) {
      return "'" + to + "' cannot be a channel name: 1 to 63 printable characters, no spaces";
    }
    channels->*name = to;
    return "";
  }
  std::string known;
  for (const std::string& name : DefaultChannelNames()) known += " " + name;
  return "there is no channel '" + from + "'; the channels are" + known;
}

std::vector<std::string> DefaultChannelNames() {
  const Channels defaults;
  std::vector<std::string> names;
  for (std::string Channels::*const name : kNames) names.push_back(defaults.*name);
  return names;
}

}  // namespace rimod
