#include "tuning/tuner.h"

#include <algorithm>
#include <utility>

namespace rimod {
namespace {

int NumFolds(const std::vector<int>& folds) {
  return folds.empty() ? 0 : 1 + *std::max_element(folds.begin(), folds.end());
}

}  // namespace

void Tuner::Run() {
  result_.best = SearchIn(Scans(true, 0), 0);
  for (int fold = 0; fold < NumFolds(plan_.folds); ++fold)
    result_.of_folds.push_back(SearchIn(Scans(false, fold), fold + 1));
  HoldOut();
}

// The trial found, also in result() when the search over all scans is broken off.
int Tuner::SearchIn(const std::vector<int>& scans, int search) {
  SearchTask task;
  task.dimensions = plan_.dimensions;
  task.start = plan_.start;
  task.scans = ShuffledScans(scans, plan_.seed);
  task.score = plan_.score;
  task.spent = plan_.begin_search(search, 1 + NumFolds(plan_.folds));
  task.seed = plan_.seed;
  Search running(std::move(task), store_);
  try {
    running.Run();
  } catch (...) {
    if (search == 0) result_.best = running.best();
    throw;
  }
  return running.best();
}

std::vector<int> Tuner::Scans(bool all, int without_fold) const {
  std::vector<int> scans;
  for (std::size_t i = 0; i < plan_.folds.size(); ++i)
    if (all || plan_.folds[i] != without_fold) scans.push_back(static_cast<int>(i));
  return scans;
}

// What was found without a fold may be better in all scans than what the search in all came upon.
void Tuner::TakeBestOfFolds(const std::vector<int>& scans) {
  for (const int trial : result_.of_folds) {
    if (!store_->Measure(trial, scans)) continue;
    const double best = plan_.score(store_->Sum(result_.best, scans));
    if (plan_.score(store_->Sum(trial, scans)) > best) result_.best = trial;
  }
}

void Tuner::HoldOut() {
  const std::vector<int> scans = Scans(true, 0);
  const int start = store_->Add(plan_.start);
  std::vector<ScanCounts> base, tuned(scans.size());
  for (const int scan : scans) base.push_back(store_->Sum(start, {scan}));
  for (std::size_t fold = 0; fold < result_.of_folds.size(); ++fold) {
    std::vector<int> held_out;
    for (const int scan : scans)
      if (plan_.folds[scan] == static_cast<int>(fold)) held_out.push_back(scan);
    // Where the setting does not work the start stands in.
    const bool works = store_->Measure(result_.of_folds[fold], held_out);
    for (const int scan : held_out)
      tuned[scan] = works ? store_->Sum(result_.of_folds[fold], {scan}) : base[scan];
  }
  for (const int scan : scans) {
    result_.base_held_out += base[scan];
    result_.tuned_held_out += tuned[scan];
  }
  TakeBestOfFolds(scans);
  result_.gain = GainOf(base, tuned, plan_.groups, plan_.score, plan_.seed);
  result_.complete = true;
}

}  // namespace rimod
