#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/partner_joiner.h"
#include "io/stage_timer.h"
#include "rimod/candidate_choice.h"
#include "rimod/shard_candidates_t.hpp"
#include "rimod/shard_t.hpp"

namespace rimod {

// Shards a scan may have; who answers beyond is not heard.
constexpr int kMaxShards = 64;

// A matcher that looks for a part of the models.
struct Shard {
  std::string name;           // 1 .. 200 printable characters; "index/count" where these are set
  int index = 0;              // 1 .. count; 0: it chose its models by name
  int count = 0;              // 0 .. kMaxShards
  std::int64_t instance = 0;  // differs from process to process
  std::int64_t params = 0;    // DigestOf its parameters
  int num_models = 0;
};

// What a shard found in a scan.
struct ShardAnswer {
  std::int64_t utime = 0;  // us, the scan's
  std::int64_t scan = 0;   // DigestOf the scan
  Shard shard;
  JudgedScan judged;
  StageTimes stage_times;
};

// Digests of values: equal values have equal ones, others hardly ever.
std::int64_t DigestOf(const DescribedScan& scan);
std::int64_t DigestOf(const PipelineParams& params);

shard_t ToMessage(const Shard& shard, std::int64_t utime);

struct ShardFromMessage {
  std::optional<Shard> shard;
  std::string error;  // the cause; empty when there is a shard
};
ShardFromMessage FromMessage(const shard_t& message);

// An answer as sections for RIMOD_SHARD_CANDIDATES, each of about kSectionBytes at most.
std::vector<shard_candidates_t> ToSections(const ShardAnswer& answer);

struct JoinedShardAnswer {
  std::optional<ShardAnswer> answer;
  std::string error;  // the cause; empty when there is an answer
};
// The answer that all its sections, in order, make, bit for bit. Counts that do not fit, values
// that are not finite, poses that are none, names that are not valid or come twice, runs of pixels
// that overlap or leave the image give an error.
JoinedShardAnswer JoinShardSections(const std::vector<shard_candidates_t>& sections);

}  // namespace rimod
