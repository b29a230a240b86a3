#include "io/shard_turn_messages.h"

#include <unistd.h>

#include <chrono>
#include <utility>

namespace rimod {

shard_scan_t ToMessage(const ShardScan& scan) {
  shard_scan_t message = {};
  message.utime = scan.utime;
  message.shard = ToMessage(scan.shard, scan.utime);
  message.scan = scan.scan;
  message.held = scan.held ? 1 : 0;
  return message;
}

shard_turn_t ToMessage(const ShardTurn& turn) {
  shard_turn_t message = {};
  message.utime = turn.utime;
  message.fuser = turn.fuser;
  message.number = turn.number;
  message.scan = turn.scan;
  return message;
}

ShardScanFromMessage FromMessage(const shard_scan_t& message) {
  ShardFromMessage shard = FromMessage(message.shard);
  if (!shard.shard) return {std::nullopt, std::move(shard.error)};
  return {ShardScan{std::move(*shard.shard), message.utime, message.scan, message.held != 0}, ""};
}

ShardTurnFromMessage FromMessage(const shard_turn_t& message) {
  if (message.number < 0) return {std::nullopt, "a turn's number is negative"};
  return {ShardTurn{message.fuser, message.number, message.utime, message.scan}, ""};
}

std::int64_t NewInstance() {
  const std::int64_t now = std::chrono::duration_cast<std::chrono::microseconds>(
                               std::chrono::system_clock::now().time_since_epoch())
                               .count();
  // Two processes that start in the same microsecond, on two hosts, have other ids most often.
  return now ^ (static_cast<std::int64_t>(getpid()) << 40);
}

}  // namespace rimod
