#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "tuning/objective.h"
#include "tuning/search_space.h"

namespace rimod {

// Detects in the given scans with a setting: counts of each; nothing when the setting is no valid
// combination.
using TrialRunner = std::function<std::optional<std::vector<ScanCounts>>(
    const Setting& setting, const std::vector<int>& scans)>;

// A setting with what is known of it.
struct Trial {
  Setting setting;
  bool valid = true;
  std::vector<std::optional<ScanCounts>> counts;  // by scan; absent: not tried there
};

// Remembers which setting did how in which scan: nothing is computed twice.
class TrialStore {
 public:
  TrialStore(int num_scans, TrialRunner runner)
      : num_scans_(num_scans), runner_(std::move(runner)) {}

  // The setting's number; equal settings have one.
  int Add(const Setting& setting);
  // Tries a setting in these scans, where it was not yet; false when it is not valid. What the
  // runner throws goes through.
  bool Measure(int trial, const std::vector<int>& scans);
  // The sum over scans in all of which it was tried.
  ScanCounts Sum(int trial, const std::vector<int>& scans) const;

  const std::vector<Trial>& trials() const { return trials_; }
  int num_invalid() const;

 private:
  int num_scans_;
  TrialRunner runner_;
  std::map<Setting, int> numbers_;
  std::vector<Trial> trials_;
};

}  // namespace rimod
