#include "io/partner_joiner.h"

#include <algorithm>
#include <utility>

namespace rimod {

std::optional<DescribedScan> PartnerJoiner::AddImage(std::int64_t utime, RangeImage image,
                                                     Time now) {
  Waiting* const waiting = FindOrAdd(utime, now);
  if (waiting->image) ++num_unpaired_;
  waiting->image = std::move(image);
  return TakeIfComplete(waiting);
}

std::optional<DescribedScan> PartnerJoiner::AddFeatures(std::int64_t utime, FeatureSet features,
                                                        Time now) {
  Waiting* const waiting = FindOrAdd(utime, now);
  if (waiting->features) ++num_unpaired_;
  waiting->features = std::move(features);
  return TakeIfComplete(waiting);
}

void PartnerJoiner::GiveUpStale(Time now) {
  while (!waiting_.empty() && now - waiting_.front().since > patience_) {
    waiting_.pop_front();
    ++num_unpaired_;
  }
}

PartnerJoiner::Waiting* PartnerJoiner::FindOrAdd(std::int64_t utime, Time now) {
  GiveUpStale(now);
  const auto found =
      std::find_if(waiting_.begin(), waiting_.end(),
                   [utime](const Waiting& waiting) { return waiting.utime == utime; });
  if (found != waiting_.end()) return &*found;
  constexpr std::size_t kMaxWaiting = 8;  // a partner follows at once; images are large
  if (waiting_.size() >= kMaxWaiting) {
    waiting_.pop_front();
    ++num_unpaired_;
  }
  waiting_.push_back({utime, now, std::nullopt, std::nullopt});
  return &waiting_.back();
}

std::optional<DescribedScan> PartnerJoiner::TakeIfComplete(Waiting* waiting) {
  if (!waiting->image || !waiting->features) return std::nullopt;
  DescribedScan scan = {waiting->utime, std::move(*waiting->image), std::move(*waiting->features)};
  waiting_.erase(std::find_if(waiting_.begin(), waiting_.end(),
                              [waiting](const Waiting& other) { return &other == waiting; }));
  return scan;
}

}  // namespace rimod
