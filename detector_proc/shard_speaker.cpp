#include "detector_proc/shard_speaker.h"

#include <utility>

namespace rimod {
namespace {

constexpr auto kPeriod = std::chrono::milliseconds(500);

std::int64_t MicrosecondsNow() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

ShardSpeaker::ShardSpeaker(const ModelShare& share, const PipelineParams& params,
                           const Channels& channels, PacedPublisher* publisher)
    : channels_(channels), publisher_(publisher) {
  shard_.name = share.Name();
  shard_.index = share.index;
  shard_.count = share.count;
  shard_.instance = NewInstance();
  shard_.params = DigestOf(params);
}

void ShardSpeaker::AnnounceIfDue(Time now) {
  if (num_models_ < 0 || now < next_) return;
  next_ = now + kPeriod;
  Shard shard = shard_;
  shard.num_models = num_models_;
  publisher_->Publish(channels_.shards, ToMessage(shard, MicrosecondsNow()));
}

void ShardSpeaker::TellScan(std::int64_t utime, std::int64_t scan, bool held) {
  Shard shard = shard_;
  shard.num_models = num_models_;
  publisher_->Publish(channels_.shard_scans, ToMessage(ShardScan{shard, utime, scan, held}));
}

void ShardSpeaker::Answer(ShardAnswer answer) {
  answer.shard = shard_;
  answer.shard.num_models = static_cast<int>(answer.judged.models.size());
  publisher_->PublishAll(channels_.shard_candidates, ToSections(answer));
}

}  // namespace rimod
