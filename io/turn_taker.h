#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "io/partner_joiner.h"
#include "io/shard_turn_messages.h"

namespace rimod {

// A shard's scans: keeps the newest ones until the fuser gives one of them its turn. While no fuser
// is heard, each is to be worked on as it comes.
class TurnTaker {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using ScanName = std::pair<std::int64_t, std::int64_t>;  // utime and digest

  // max_waiting: scans that may wait; >= 1.
  explicit TurnTaker(int max_waiting = 1) : max_held_(static_cast<std::size_t>(max_waiting) + 2) {}

  // Each returns the scan to work on now; mostly nothing.
  std::optional<DescribedScan> Add(DescribedScan scan, std::int64_t digest, Time now);
  std::optional<DescribedScan> Hear(const ShardTurn& turn, Time now);
  // Where the fuser has fallen silent, or gives no turns, as one with other parameters.
  std::optional<DescribedScan> OnIdle(Time now);

  // True once after each turn of a scan that is not here: the fuser must not wait for it.
  bool TakeLacking();
  const ShardTurn& turn() const { return turn_; }
  // Scans that a newer one left behind.
  std::int64_t num_overtaken() const { return num_overtaken_; }
  std::size_t num_held() const { return held_.size(); }

 private:
  struct Held {
    ScanName name;
    DescribedScan scan;
  };
  bool IsConducted(Time now) const;
  DescribedScan Take(std::size_t index);
  void RememberTaken(const ScanName& name);

  // Two more than may wait: the fuser may choose by what another shard has got.
  std::size_t max_held_;
  std::deque<Held> held_;  // oldest first
  ShardTurn turn_;
  std::optional<Time> heard_;   // the fuser
  Time waiting_since_;          // of the held scans, or the last turn
  std::deque<ScanName> taken_;  // of late
  bool is_lacking_ = false;
  std::int64_t num_overtaken_ = 0;
};

}  // namespace rimod
