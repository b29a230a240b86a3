#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/shard_messages.h"
#include "rimod/shard_scan_t.hpp"
#include "rimod/shard_turn_t.hpp"

namespace rimod {

// That a shard has a scan, or, asked for it, has it not.
struct ShardScan {
  Shard shard;
  std::int64_t utime = 0;  // us, the scan's
  std::int64_t scan = 0;   // DigestOf the scan
  bool held = true;
};

// Which scan the shards are to work on.
struct ShardTurn {
  std::int64_t fuser = 0;   // differs from process to process
  std::int64_t number = 0;  // 1, 2, ..; 0: none yet
  std::int64_t utime = 0;   // us, the scan's
  std::int64_t scan = 0;    // DigestOf the scan
};

shard_scan_t ToMessage(const ShardScan& scan);
shard_turn_t ToMessage(const ShardTurn& turn);

struct ShardScanFromMessage {
  std::optional<ShardScan> scan;
  std::string error;  // the cause; empty when there is a scan
};
// Errors as FromMessage(shard_t).
ShardScanFromMessage FromMessage(const shard_scan_t& message);

struct ShardTurnFromMessage {
  std::optional<ShardTurn> turn;
  std::string error;  // the cause; empty when there is a turn
};
// A negative number gives an error.
ShardTurnFromMessage FromMessage(const shard_turn_t& message);

// Of this process: differs from that of any other, also after a restart.
std::int64_t NewInstance();

}  // namespace rimod
