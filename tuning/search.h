#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <set>
#include <vector>

#include "tuning/trial_store.h"

namespace rimod {

// Looks for the setting with the highest score over some scans. Takes turns: quasi-random settings
// in groups of eight, of which the better half goes on to more scans (successive halving), and
// steps along one dimension at a time from the best so far, which become smaller. With a budget
// that depends on the number of settings alone the result depends on the seed alone.
struct SearchTask {
  std::vector<Dimension> dimensions;  // at most kMaxDimensions
  Setting start;                      // the setting to be beaten; valid
  std::vector<int> scans;             // the first ones are tried first; not empty
  std::function<double(const ScanCounts&)> score;
  // How much of the budget is spent after so many settings looked at; 1: stop. Asked before each.
  std::function<double(int num_settings)> spent;
  std::uint64_t seed = 1;
};

constexpr int kMaxDimensions = 16;

class Search {
 public:
  // Throws std::invalid_argument for too many dimensions and a task without scans.
  Search(SearchTask task, TrialStore* store);

  // Ends with the budget, or when nothing is left to look at. What the store throws goes through.
  void Run();

  // The best trial tried in all scans; of equal ones that with fewer changes from the start. -1
  // before the start itself was tried. Also right after an exception of Run.
  int best() const { return best_; }
  int num_settings() const { return static_cast<int>(seen_.size()); }

 private:
  double Spent() const { return task_.spent(num_settings()); }
  void TryStart();
  void Explore();
  void Refine();
  bool RefineDimension(std::size_t dimension, double step);
  Setting NextQuasiRandom();
  std::vector<int> FirstScans(double share) const;
  double Score(int trial, const std::vector<int>& scans) const;
  int NumChanges(int trial) const;
  bool Challenge(int trial);
  bool TakeIfBetter(int trial);

  SearchTask task_;
  TrialStore* store_;
  std::mt19937_64 random_;
  std::vector<double> shifts_;  // of the quasi-random sequence, by dimension
  int num_drawn_ = 0;
  std::set<Setting> seen_;
  int best_ = -1;
  bool refined_ = false;    // nothing better next to the best
  bool exhausted_ = false;  // drawing gives nothing new
};

}  // namespace rimod
