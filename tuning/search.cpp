#include "tuning/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace rimod {
namespace {

constexpr std::array<int, kMaxDimensions> kPrimes = {2,  3,  5,  7,  11, 13, 17, 19,
                                                     23, 29, 31, 37, 41, 43, 47, 53};
// Of the scans, in which settings are compared before they are tried in more.
constexpr std::array<double, 3> kRungs = {0.25, 0.5, 1.0};

// The number with its digits mirrored at the point: spread evenly over 0 .. 1 (Halton).
double RadicalInverse(int number, int base) {
  double inverse = 0.0, digit = 1.0;
  for (int rest = number; rest > 0; rest /= base) {
    digit /= base;
    inverse += digit * (rest % base);
  }
  return inverse;
}

}  // namespace

Search::Search(SearchTask task, TrialStore* store)
    : task_(std::move(task)), store_(store), random_(task_.seed) {
  if (task_.dimensions.size() > kMaxDimensions)
    throw std::invalid_argument(std::to_string(task_.dimensions.size()) +
                                " parameters to vary, at most " + std::to_string(kMaxDimensions));
  if (task_.scans.empty()) throw std::invalid_argument("no scans to compare parameters in");
  for (std::size_t i = 0; i < task_.dimensions.size(); ++i)
    shifts_.push_back(static_cast<double>(random_() >> 11) * 0x1.0p-53);
}

void Search::Run() {
  constexpr double kExploring = 0.5;  // of the budget, before the first refinement
  TryStart();
  while (Spent() < 1.0 && !(exhausted_ && refined_)) {
    const bool explore = !exhausted_ && (refined_ || Spent() < kExploring);
    explore ? Explore() : Refine();
  }
}

void Search::TryStart() {
  const int start = store_->Add(task_.start);
  seen_.insert(task_.start);
  if (!store_->Measure(start, task_.scans))
    throw std::invalid_argument("the parameters to start from cannot be used");
  best_ = start;
}

Setting Search::NextQuasiRandom() {
  ++num_drawn_;
  Setting setting;
  for (std::size_t i = 0; i < task_.dimensions.size(); ++i) {
    const double place = RadicalInverse(num_drawn_, kPrimes[i]) + shifts_[i];
    setting.push_back(task_.dimensions[i].ValueAt(place - std::floor(place)));
  }
  return setting;
}

// One group by successive halving.
void Search::Explore() {
  constexpr int kGroup = 8;
  constexpr int kMaxDraws = 200;  // where few combinations exist most draws give old ones
  std::vector<int> group;
  for (int draw = 0; draw < kMaxDraws && group.size() < kGroup; ++draw) {
    const Setting setting = NextQuasiRandom();
    if (!seen_.insert(setting).second) continue;
    const int trial = store_->Add(setting);
    if (store_->Measure(trial, FirstScans(kRungs[0]))) group.push_back(trial);
    if (Spent() >= 1.0) break;
    draw = 0;
  }
  exhausted_ = group.size() < kGroup && Spent() < 1.0;
  for (std::size_t rung = 1; rung < kRungs.size(); ++rung) {
    const std::vector<int> before = FirstScans(kRungs[rung - 1]);
    std::stable_sort(group.begin(), group.end(),
                     [&](int a, int b) { return Score(a, before) > Score(b, before); });
    group.resize((group.size() + 1) / 2);
    const std::vector<int> scans = FirstScans(kRungs[rung]);
    group.erase(std::remove_if(group.begin(), group.end(),
                               [&](int trial) { return !store_->Measure(trial, scans); }),
                group.end());
  }
  for (const int trial : group) TakeIfBetter(trial);
}

// Steps along each dimension from the best, again with half the step when none was better.
void Search::Refine() {
  constexpr double kFirstStep = 0.25, kLastStep = 1.0 / 32.0;  // of the range
  for (double step = kFirstStep; step >= kLastStep;) {
    bool better = false;
    for (std::size_t i = 0; i < task_.dimensions.size(); ++i)
      better = RefineDimension(i, step) || better;
    if (Spent() >= 1.0) return;
    if (!better) step /= 2.0;
  }
  refined_ = true;
}

bool Search::RefineDimension(std::size_t i, double step) {
  const Dimension& dimension = task_.dimensions[i];
  const double length = std::max(step, dimension.SmallestStep());
  for (const double signed_step : {length, -length}) {
    Setting setting = store_->trials()[best_].setting;
    setting[i] = dimension.ValueAt(dimension.PlaceOf(setting[i]) + signed_step);
    if (Spent() >= 1.0) return false;
    if (!seen_.insert(setting).second) continue;
    if (Challenge(store_->Add(setting))) return true;
  }
  return false;
}

// Tries a setting in more and more scans as long as it is about as good as the best.
bool Search::Challenge(int trial) {
  // A few scans tell scores only so well, so that less is no reason to give up.
  constexpr double kMargin = 0.05;  // of the best's score
  for (const double rung : kRungs) {
    const std::vector<int> scans = FirstScans(rung);
    if (!store_->Measure(trial, scans)) return false;
    const double best = Score(best_, scans);
    if (Score(trial, scans) < best - kMargin * std::abs(best)) return false;
  }
  return TakeIfBetter(trial);
}

bool Search::TakeIfBetter(int trial) {
  const double score = Score(trial, task_.scans);
  const double best = Score(best_, task_.scans);
  if (score < best || (score == best && NumChanges(trial) >= NumChanges(best_))) return false;
  best_ = trial;
  refined_ = false;
  return true;
}

std::vector<int> Search::FirstScans(double share) const {
  const double number = std::ceil(share * static_cast<double>(task_.scans.size()));
  return {task_.scans.begin(), task_.scans.begin() + static_cast<std::ptrdiff_t>(number)};
}

double Search::Score(int trial, const std::vector<int>& scans) const {
  return task_.score(store_->Sum(trial, scans));
}

int Search::NumChanges(int trial) const {
  const Setting& setting = store_->trials()[trial].setting;
  int changes = 0;
  for (std::size_t i = 0; i < setting.size(); ++i) changes += setting[i] != task_.start[i] ? 1 : 0;
  return changes;
}

}  // namespace rimod
