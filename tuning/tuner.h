#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tuning/cross_validation.h"
#include "tuning/search.h"

namespace rimod {

// How parameters are chosen and how honestly that is judged.
struct TuningPlan {
  std::vector<Dimension> dimensions;
  Setting start;
  std::vector<int> groups;  // of each scan: scans that belong together
  std::vector<int> folds;   // of each scan, from 0 without gaps
  std::function<double(const ScanCounts&)> score;
  std::uint64_t seed = 1;
  // Called when a search begins, 0 .. num_searches - 1; gives SearchTask::spent.
  std::function<std::function<double(int)>(int search, int num_searches)> begin_search;
};

struct TuningResult {
  int best = -1;              // trial that is best in all scans; -1: none was tried in all
  std::vector<int> of_folds;  // trial chosen without the fold's scans; those that were finished
  bool complete = false;      // all folds were finished; what follows is known then only
  ScanCounts base_held_out;   // the start
  ScanCounts tuned_held_out;  // each fold with what was chosen without it
  Gain gain;                  // of these two
};

// One search over all scans gives the parameters; one over all but each fold's scans tells what
// such a search is worth in scans that it has not seen.
class Tuner {
 public:
  Tuner(TuningPlan plan, TrialStore* store) : plan_(std::move(plan)), store_(store) {}

  // What the store throws goes through; result() has then what was known before.
  void Run();
  const TuningResult& result() const { return result_; }

 private:
  int SearchIn(const std::vector<int>& scans, int search);
  std::vector<int> Scans(bool all, int without_fold) const;
  void HoldOut();
  void TakeBestOfFolds(const std::vector<int>& scans);

  TuningPlan plan_;
  TrialStore* store_;
  TuningResult result_;
};

}  // namespace rimod
