#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tuning/objective.h"

namespace rimod {

// Deals groups of scans that belong together (the sweeps of one log) out to folds: the fold of each
// scan, 0 .. num_folds - 1. Folds have numbers of groups that differ by one at most; the seed alone
// decides which. groups: the group of each scan, from 0 without gaps. Throws std::invalid_argument
// for fewer groups than folds.
std::vector<int> AssignFolds(const std::vector<int>& groups, int num_folds, std::uint64_t seed);

// The scans in the order in which they are tried: shuffled, so that the first ones are like all.
std::vector<int> ShuffledScans(std::vector<int> scans, std::uint64_t seed);

// How much better one score is than another.
struct Gain {
  double value = 0.0;
  double low = 0.0, high = 0.0;  // 90 % of resampled sets of groups lie between
  // Larger than chance alone would make it: in 95 % of the resampled sets there is a gain.
  bool clear() const { return low > 0.0; }
};

// A paired bootstrap over groups; the same for the same seed. Both have the same scans.
Gain GainOf(const std::vector<ScanCounts>& base, const std::vector<ScanCounts>& tuned,
            const std::vector<int>& groups, const std::function<double(const ScanCounts&)>& score,
            std::uint64_t seed);

}  // namespace rimod
