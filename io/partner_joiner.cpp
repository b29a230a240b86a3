#include "io/partner_joiner.h"

#include <algorithm>
#include <utility>

#include "rimod/feature_origin.h"

namespace rimod {

std::optional<DescribedScan> PartnerJoiner::AddImage(std::int64_t utime, RangeImage image,
                                                     Time now) {
  return Add({utime, now, std::move(image), std::nullopt}, now);
}

std::optional<DescribedScan> PartnerJoiner::AddFeatures(std::int64_t utime, FeatureSet features,
                                                        Time now) {
  return Add({utime, now, std::nullopt, std::move(features)}, now);
}

void PartnerJoiner::GiveUpStale(Time now) {
  while (!waiting_.empty() && now - waiting_.front().since > patience_) {
    waiting_.pop_front();
    ++num_unpaired_;
  }
}

std::optional<DescribedScan> PartnerJoiner::Add(Waiting part, Time now) {
  GiveUpStale(now);
  const std::size_t index = PartnerOf(part);
  if (index < waiting_.size()) {
    Waiting& partner = waiting_[index];
    DescribedScan scan;
    scan.utime = part.utime;
    scan.image = std::move(part.image ? *part.image : *partner.image);
    scan.features = std::move(part.features ? *part.features : *partner.features);
    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(index));
    return scan;
  }
  constexpr std::size_t kMaxWaiting = 8;  // a partner follows at once; images are large
  if (waiting_.size() >= kMaxWaiting) {
    waiting_.pop_front();
    ++num_unpaired_;
  }
  waiting_.push_back(std::move(part));
  return std::nullopt;
}

std::size_t PartnerJoiner::PartnerOf(const Waiting& part) {
  std::size_t empty_one = waiting_.size();
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    const Waiting& other = waiting_[i];
    if (other.utime != part.utime || other.image.has_value() == part.image.has_value()) continue;
    const RangeImage& image = part.image ? *part.image : *other.image;
    const FeatureSet& features = part.features ? *part.features : *other.features;
    if (features.features.empty()) {
      empty_one = std::min(empty_one, i);
    } else if (AreFeaturesOf(image, features)) {
      return i;
    } else {
      ++num_refused_;
      refused_utime_ = part.utime;
    }
  }
  return IsOnlyImage(part) ? empty_one : waiting_.size();
}

// Of its utime, with those that wait.
bool PartnerJoiner::IsOnlyImage(const Waiting& part) const {
  const auto num_waiting = std::count_if(
      waiting_.begin(), waiting_.end(),
      [&part](const Waiting& other) { return other.utime == part.utime && other.image; });
  return num_waiting + (part.image ? 1 : 0) == 1;
}

}  // namespace rimod
