#include "tuning/trial_store.h"

#include <algorithm>
#include <cassert>

namespace rimod {

int TrialStore::Add(const Setting& setting) {
  const auto [place, is_new] = numbers_.emplace(setting, static_cast<int>(trials_.size()));
  if (is_new) {
    trials_.emplace_back();
    trials_.back().setting = setting;
    trials_.back().counts.resize(num_scans_);
  }
  return place->second;
}

bool TrialStore::Measure(int number, const std::vector<int>& scans) {
  Trial& trial = trials_[number];
  if (!trial.valid) return false;
  std::vector<int> open;
  for (const int scan : scans)
    if (!trial.counts[scan]) open.push_back(scan);
  if (open.empty()) return true;
  const std::optional<std::vector<ScanCounts>> counts = runner_(trial.setting, open);
  trial.valid = counts.has_value();
  if (!counts) return false;
  assert(counts->size() == open.size());
  for (std::size_t i = 0; i < open.size(); ++i) trial.counts[open[i]] = (*counts)[i];
  return true;
}

ScanCounts TrialStore::Sum(int trial, const std::vector<int>& scans) const {
  ScanCounts sum;
  for (const int scan : scans) {
    assert(trials_[trial].counts[scan]);
    sum += *trials_[trial].counts[scan];
  }
  return sum;
}

int TrialStore::num_invalid() const {
  return static_cast<int>(
      std::count_if(trials_.begin(), trials_.end(), [](const Trial& t) { return !t.valid; }));
}

}  // namespace rimod
