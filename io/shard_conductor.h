#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "io/shard_turn_messages.h"

namespace rimod {

struct ShardConductorParams {
  std::chrono::milliseconds patience{5000};  // a turn lasts at most so long
  int max_waiting = 1;  // scans that wait for their turn; further ones push the oldest out
  // So long the fuser waits for the others to get a scan that some shards have.
  std::chrono::milliseconds grace{150};
};

// Tells shards which scan to work on, so that all of them work on the same one however much faster
// scans come than they are done. A turn ends when all who have its scan have answered it or are
// gone; the next is the newest scan that all shards have by then (where more than one may wait: the
// oldest of so many newest ones), older ones are overtaken. A scan that some shards have lost gets
// its turn, too, once the others have had time to get it.
class ShardConductor {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit ShardConductor(const ShardConductorParams& params = {}) : params_(params) {}

  // A shard has the scan, or has it no more.
  void Hear(const ShardScan& scan, Time now);
  void Answered(const Shard& shard, std::int64_t utime, std::int64_t scan);
  // Begins the next turn where it is time for it; returns whether it did. present: the shards'
  // names.
  bool Advance(const std::vector<std::string>& present, Time now);

  // The last one that began; number 0 where none has.
  const ShardTurn& turn() const { return turn_; }
  // Turns that ended without the answer of a shard that has the scan.
  std::int64_t num_given_up() const { return num_given_up_; }
  std::size_t num_offered() const { return offered_.size(); }

 private:
  using Holders = std::map<std::string, std::int64_t>;  // shards' names and instances
  struct Offered {
    std::int64_t utime = 0, scan = 0;
    Time since;
    Holders holders;
  };
  bool IsOver(const std::vector<std::string>& present, Time now);
  // The one for the next turn; offered_.size() where it is too early for any.
  std::size_t Choose(const std::vector<std::string>& present, Time now) const;

  ShardConductorParams params_;
  ShardTurn turn_;
  Time turn_begin_;
  Holders working_;               // on the turn's scan
  std::vector<Offered> offered_;  // oldest first
  std::int64_t num_given_up_ = 0;
};

}  // namespace rimod
