#include "tuning/cross_validation.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>

namespace rimod {
namespace {

// std::shuffle's result is the library's own affair.
void Shuffle(std::vector<int>* values, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (std::size_t i = values->size(); i > 1; --i)
    std::swap((*values)[i - 1], (*values)[random() % i]);
}

int NumGroups(const std::vector<int>& groups) {
  return groups.empty() ? 0 : 1 + *std::max_element(groups.begin(), groups.end());
}

std::vector<ScanCounts> SumOfGroups(const std::vector<ScanCounts>& counts,
                                    const std::vector<int>& groups) {
  std::vector<ScanCounts> sums(NumGroups(groups));
  for (std::size_t i = 0; i < counts.size(); ++i) sums[groups[i]] += counts[i];
  return sums;
}

ScanCounts Total(const std::vector<ScanCounts>& counts) {
  ScanCounts total;
  for (const ScanCounts& count : counts) total += count;
  return total;
}

}  // namespace

std::vector<int> AssignFolds(const std::vector<int>& groups, int num_folds, std::uint64_t seed) {
  const int num_groups = NumGroups(groups);
  if (num_folds < 2 || num_groups < num_folds)
    throw std::invalid_argument(std::to_string(num_groups) + " logs or scans do not make " +
                                std::to_string(num_folds) + " folds");
  std::vector<int> order(num_groups);
  std::iota(order.begin(), order.end(), 0);
  Shuffle(&order, seed);
  std::vector<int> fold_of_group(num_groups);
  for (int i = 0; i < num_groups; ++i) fold_of_group[order[i]] = i % num_folds;
  std::vector<int> folds;
  for (const int group : groups) folds.push_back(fold_of_group[group]);
  return folds;
}

std::vector<int> ShuffledScans(std::vector<int> scans, std::uint64_t seed) {
  Shuffle(&scans, seed);
  return scans;
}

Gain GainOf(const std::vector<ScanCounts>& base, const std::vector<ScanCounts>& tuned,
            const std::vector<int>& groups, const std::function<double(const ScanCounts&)>& score,
            std::uint64_t seed) {
  constexpr int kResamples = 2000;
  constexpr double kTail = 0.05;  // on each side
  const std::vector<ScanCounts> base_sums = SumOfGroups(base, groups);
  const std::vector<ScanCounts> tuned_sums = SumOfGroups(tuned, groups);
  Gain gain;
  gain.value = score(Total(tuned)) - score(Total(base));
  if (base_sums.empty()) return gain;
  std::mt19937_64 random(seed);
  std::vector<double> gains;
  for (int resample = 0; resample < kResamples; ++resample) {
    ScanCounts base_total, tuned_total;
    for (std::size_t i = 0; i < base_sums.size(); ++i) {
      const std::size_t group = random() % base_sums.size();
      base_total += base_sums[group];
      tuned_total += tuned_sums[group];
    }
    gains.push_back(score(tuned_total) - score(base_total));
  }
  std::sort(gains.begin(), gains.end());
  gain.low = gains[static_cast<std::size_t>(kTail * kResamples)];
  gain.high = gains[static_cast<std::size_t>((1.0 - kTail) * kResamples)];
  return gain;
}

}  // namespace rimod
