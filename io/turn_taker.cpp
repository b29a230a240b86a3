#include "io/turn_taker.h"

#include <algorithm>
#include <chrono>

namespace rimod {
namespace {

// Ten turns unheard: no fuser is there.
constexpr auto kSilence = std::chrono::milliseconds(1000);

constexpr std::size_t kMaxTaken = 8;

// A turn comes within the fuser's patience where one comes at all.
constexpr auto kLongestWait = std::chrono::milliseconds(10'000);

}  // namespace

bool TurnTaker::IsConducted(Time now) const { return heard_ && now - *heard_ <= kSilence; }

std::optional<DescribedScan> TurnTaker::Add(DescribedScan scan, std::int64_t digest, Time now) {
  const ScanName name(scan.utime, digest);
  // The same scan again, as when a log is replayed, waits for a turn of its own.
  const bool is_late_for_turn = turn_.number > 0 && name == ScanName(turn_.utime, turn_.scan) &&
                                std::find(taken_.begin(), taken_.end(), name) == taken_.end();
  if (held_.empty()) waiting_since_ = now;
  held_.push_back({name, std::move(scan)});
  if (!IsConducted(now) || is_late_for_turn) return Take(held_.size() - 1);
  if (held_.size() > max_held_) {
    held_.pop_front();
    ++num_overtaken_;
  }
  return std::nullopt;
}

std::optional<DescribedScan> TurnTaker::Hear(const ShardTurn& turn, Time now) {
  // Of two fusers all shards follow the same one.
  if (IsConducted(now) && turn.fuser > turn_.fuser) return std::nullopt;
  heard_ = now;
  if (turn.fuser == turn_.fuser && turn.number == turn_.number) return std::nullopt;
  const bool is_new_fuser = turn.fuser != turn_.fuser;
  turn_ = turn;
  waiting_since_ = now;
  const ScanName name(turn.utime, turn.scan);
  const auto held = std::find_if(held_.begin(), held_.end(),
                                 [&name](const Held& item) { return item.name == name; });
  if (turn.number > 0 && held != held_.end())
    return Take(static_cast<std::size_t>(held - held_.begin()));
  is_lacking_ = turn.number > 0 && std::find(taken_.begin(), taken_.end(), name) == taken_.end();
  // It was not told of what is held here.
  if (is_new_fuser && !held_.empty()) return Take(held_.size() - 1);
  return std::nullopt;
}

std::optional<DescribedScan> TurnTaker::OnIdle(Time now) {
  if (held_.empty()) return std::nullopt;
  if (IsConducted(now) && now - waiting_since_ <= kLongestWait) return std::nullopt;
  waiting_since_ = now;
  return Take(held_.size() - 1);
}

bool TurnTaker::TakeLacking() { return std::exchange(is_lacking_, false); }

DescribedScan TurnTaker::Take(std::size_t index) {
  DescribedScan scan = std::move(held_[index].scan);
  RememberTaken(held_[index].name);
  num_overtaken_ += static_cast<std::int64_t>(index);
  held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(index) + 1);
  return scan;
}

void TurnTaker::RememberTaken(const ScanName& name) {
  taken_.push_back(name);
  if (taken_.size() > kMaxTaken) taken_.pop_front();
}

}  // namespace rimod
