#pragma once

#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/channels.h"
#include "io/config.h"
#include "io/paced_publisher.h"
#include "io/raw_subscription.h"
#include "io/section_joiner.h"
#include "io/sender_watch.h"
#include "io/shard_conductor.h"
#include "io/shard_joiner.h"
#include "io/status_reporter.h"
#include "rimod/shard_candidates_t.hpp"
#include "rimod/shard_scan_t.hpp"
#include "rimod/shard_t.hpp"

namespace rimod {

// What matchers that share the models found in, the scan's pose hypotheses and detections out: the
// same as of one matcher with all models, to the bit. Shards come and go while it runs; a missing
// one costs its models only. It tells the shards which scan to work on, so that under overload all
// of them leave out the same ones.
class FuserProcess {
 public:
  // Both LCM instances (they may be one) must outlive the process.
  FuserProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
               const Configuration& configuration);

  // To be called many times a second: fuses what is not waited for any more, and reports.
  void OnIdle();

 private:
  std::string OnShard(const shard_t& message);
  std::string OnShardScan(const shard_scan_t& message);
  std::string OnCandidates(shard_candidates_t section);
  // The cause where a shard works with other parameters, as its result would not fit; else empty.
  std::string CheckParams(const Shard& shard) const;
  // Tells the shards whose turn it is; a turn that goes on is told again and again.
  void Conduct();
  void FuseDecided();
  void Fuse(AnsweredScan scan);
  void ReportOverlap(const AnsweredScan& scan);
  void ReportShards();

  const Channels channels_;
  const PipelineParams params_;
  const std::int64_t params_digest_;
  SectionJoiner<shard_candidates_t> sections_;
  ShardJoiner shards_;
  ShardConductor conductor_;
  const std::int64_t instance_;
  std::chrono::steady_clock::time_point next_turn_told_;
  StatusReporter status_;
  SenderWatch senders_;
  PacedPublisher publisher_;
  std::int64_t num_partial_ = 0;                     // scans that lacked a shard
  std::map<std::string, std::int64_t> num_without_;  // scans, by shard
  std::vector<std::string> missing_;                 // as last reported
  std::vector<std::unique_ptr<BytesSubscription>> subscriptions_;
};

}  // namespace rimod
