#pragma once

#include <atomic>
#include <chrono>
#include <string>

#include "io/channels.h"
#include "io/model_split.h"
#include "io/paced_publisher.h"
#include "io/shard_turn_messages.h"
#include "rimod/params.h"

namespace rimod {

// What a matcher that is a shard says: that it is there, and what it found.
class ShardSpeaker {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // The publisher must outlive it.
  ShardSpeaker(const ModelShare& share, const PipelineParams& params, const Channels& channels,
               PacedPublisher* publisher);

  // How many models it looks for; from the first call on it is ready.
  void SetNumModels(int num_models) { num_models_ = num_models; }
  bool is_ready() const { return num_models_ >= 0; }
  // Twice a second, once it is ready.
  void AnnounceIfDue(Time now);
  // Fills in who answers.
  void Answer(ShardAnswer answer);
  // That the scan is here, or is not (any more).
  void TellScan(std::int64_t utime, std::int64_t scan, bool held);

 private:
  Shard shard_;                      // but for the number of models
  std::atomic<int> num_models_{-1};  // not ready yet
  Channels channels_;
  PacedPublisher* publisher_;
  Time next_;
};

}  // namespace rimod
