#include "io/shard_conductor.h"

#include <algorithm>

namespace rimod {
namespace {

// Some that not all shards have.
constexpr std::size_t kMaxLacking = 16;

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// A process of this name that is not the same has not what its predecessor had.
void Forget(const Shard& shard, std::map<std::string, std::int64_t>* holders) {
  const auto holder = holders->find(shard.name);
  if (holder != holders->end() && holder->second != shard.instance) holders->erase(holder);
}

}  // namespace

void ShardConductor::Hear(const ShardScan& scan, Time now) {
  Forget(scan.shard, &working_);
  for (Offered& offered : offered_) Forget(scan.shard, &offered.holders);
  const bool is_turn =
      turn_.number > 0 && scan.utime == turn_.utime && scan.scan == turn_.scan && !working_.empty();
  auto offered = std::find_if(offered_.begin(), offered_.end(), [&scan](const Offered& item) {
    return item.utime == scan.utime && item.scan == scan.scan;
  });
  if (!scan.held) {
    if (is_turn) working_.erase(scan.shard.name);
    if (offered != offered_.end()) offered->holders.erase(scan.shard.name);
    return;
  }
  if (is_turn) {
    working_[scan.shard.name] = scan.shard.instance;
    return;
  }
  if (offered == offered_.end()) {
    if (offered_.size() >= kMaxLacking + static_cast<std::size_t>(params_.max_waiting))
      offered_.erase(offered_.begin());
    offered_.push_back({scan.utime, scan.scan, now, {}});
    offered = offered_.end() - 1;
  }
  if (offered->holders.size() < static_cast<std::size_t>(kMaxShards))
    offered->holders[scan.shard.name] = scan.shard.instance;
}

void ShardConductor::Answered(const Shard& shard, std::int64_t utime, std::int64_t scan) {
  if (utime == turn_.utime && scan == turn_.scan) working_.erase(shard.name);
}

bool ShardConductor::IsOver(const std::vector<std::string>& present, Time now) {
  for (auto it = working_.begin(); it != working_.end();)
    it = Contains(present, it->first) ? std::next(it) : working_.erase(it);
  if (!working_.empty() && now - turn_begin_ >= params_.patience) {
    ++num_given_up_;
    working_.clear();
  }
  return working_.empty();
}

std::size_t ShardConductor::Choose(const std::vector<std::string>& present, Time now) const {
  std::vector<std::size_t> best;  // of those that the most shards have, oldest first
  std::size_t most = 0;
  bool is_late = false;
  for (std::size_t i = 0; i < offered_.size(); ++i) {
    const auto num_holders = static_cast<std::size_t>(std::count_if(
        present.begin(), present.end(),
        [&](const std::string& name) { return offered_[i].holders.count(name) != 0; }));
    if (num_holders == 0) continue;
    is_late = is_late || now - offered_[i].since >= params_.grace;
    if (num_holders > most) best.clear();
    most = std::max(most, num_holders);
    if (num_holders == most) best.push_back(i);
  }
  if (best.empty() || (most < present.size() && !is_late)) return offered_.size();
  const auto num_waiting = static_cast<std::size_t>(params_.max_waiting);
  return best[best.size() - std::min(num_waiting, best.size())];
}

bool ShardConductor::Advance(const std::vector<std::string>& present, Time now) {
  if (!IsOver(present, now)) return false;
  const std::size_t chosen = Choose(present, now);
  if (chosen == offered_.size()) return false;
  turn_ = {turn_.fuser, turn_.number + 1, offered_[chosen].utime, offered_[chosen].scan};
  turn_begin_ = now;
  working_ = std::move(offered_[chosen].holders);
  offered_.erase(offered_.begin(), offered_.begin() + static_cast<std::ptrdiff_t>(chosen) + 1);
  return true;
}

}  // namespace rimod
