#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

#include "rimod/features.h"
#include "rimod/range_image.h"

namespace rimod {

// Range image and features of one scan.
struct DescribedScan {
  std::int64_t utime = 0;  // us, the scan's
  RangeImage image;
  FeatureSet features;
};

// Brings the range image and the features of a scan together by utime, whichever comes first.
class PartnerJoiner {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // One that waits for its partner longer than patience is given up.
  explicit PartnerJoiner(std::chrono::milliseconds patience) : patience_(patience) {}

  // Each returns the scan that is complete now; mostly every other call. A second image or feature
  // set of one utime takes the place of the first.
  std::optional<DescribedScan> AddImage(std::int64_t utime, RangeImage image, Time now);
  std::optional<DescribedScan> AddFeatures(std::int64_t utime, FeatureSet features, Time now);
  void GiveUpStale(Time now);

  // Images and feature sets that got no partner.
  std::int64_t num_unpaired() const { return num_unpaired_; }

 private:
  struct Waiting {
    std::int64_t utime = 0;
    Time since;
    std::optional<RangeImage> image;
    std::optional<FeatureSet> features;
  };
  Waiting* FindOrAdd(std::int64_t utime, Time now);
  std::optional<DescribedScan> TakeIfComplete(Waiting* waiting);

  std::chrono::milliseconds patience_;
  std::deque<Waiting> waiting_;  // oldest first
  std::int64_t num_unpaired_ = 0;
};

}  // namespace rimod
