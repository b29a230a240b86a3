#pragma once

#include <chrono>
#include <cstddef>
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

// Brings the range image and the features of a scan together, whichever comes first: by utime, and
// by what they hold, as several scans may have one utime. Features are paired with the image that
// they were extracted from (AreFeaturesOf) and with no other; an empty feature set, which fits
// every image, only where one image alone waits for it.
class PartnerJoiner {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // One that waits for its partner longer than patience is given up.
  explicit PartnerJoiner(std::chrono::milliseconds patience) : patience_(patience) {}

  // Each returns the scan that is complete now; mostly every other call.
  std::optional<DescribedScan> AddImage(std::int64_t utime, RangeImage image, Time now);
  std::optional<DescribedScan> AddFeatures(std::int64_t utime, FeatureSet features, Time now);
  void GiveUpStale(Time now);

  // Images and feature sets that got no partner.
  std::int64_t num_unpaired() const { return num_unpaired_; }
  // Times that an image and features of one utime were found to be of two scans.
  std::int64_t num_refused() const { return num_refused_; }
  // us, of the last of those.
  std::int64_t refused_utime() const { return refused_utime_; }

 private:
  struct Waiting {  // either an image or features
    std::int64_t utime = 0;
    Time since;
    std::optional<RangeImage> image;
    std::optional<FeatureSet> features;
  };
  std::optional<DescribedScan> Add(Waiting part, Time now);
  // The one to pair with; waiting_.size() where there is none.
  std::size_t PartnerOf(const Waiting& part);
  bool IsOnlyImage(const Waiting& part) const;

  std::chrono::milliseconds patience_;
  std::deque<Waiting> waiting_;  // oldest first
  std::int64_t num_unpaired_ = 0;
  std::int64_t num_refused_ = 0;
  std::int64_t refused_utime_ = 0;
};

}  // namespace rimod
