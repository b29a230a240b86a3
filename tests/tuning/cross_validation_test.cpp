#include "tuning/cross_validation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "tuning/tuner.h"

namespace rimod {
namespace {

double F1(const ScanCounts& counts) { return ObjectiveFrom("f1")->Score(counts); }

ScanCounts Counts(int right, int missed) {
  ScanCounts counts;
  counts.scans = 1;
  counts.right = right;
  counts.missed = missed;
  return counts;
}

TEST(CrossValidationTest, GroupsStayTogetherAndFoldsAreEven) {
  const std::vector<int> groups = {0, 0, 1, 2, 2, 2, 3, 4, 5, 6};
  const std::vector<int> folds = AssignFolds(groups, 3, 5);
  std::map<int, std::set<int>> folds_of_group, groups_of_fold;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    folds_of_group[groups[i]].insert(folds[i]);
    groups_of_fold[folds[i]].insert(groups[i]);
  }
  for (const auto& [group, its_folds] : folds_of_group) EXPECT_EQ(its_folds.size(), 1u);
  ASSERT_EQ(groups_of_fold.size(), 3u);
  for (const auto& [fold, its_groups] : groups_of_fold) {
    EXPECT_GE(its_groups.size(), 2u);
    EXPECT_LE(its_groups.size(), 3u);
  }
  EXPECT_EQ(folds, AssignFolds(groups, 3, 5));
  EXPECT_THROW(AssignFolds({0, 0, 1}, 3, 1), std::invalid_argument);
}

TEST(CrossValidationTest, ShufflingKeepsEachScanOnce) {
  std::vector<int> scans = ShuffledScans({3, 1, 4, 5, 9}, 7);
  EXPECT_EQ(scans, ShuffledScans({3, 1, 4, 5, 9}, 7));
  std::sort(scans.begin(), scans.end());
  EXPECT_EQ(scans, (std::vector<int>{1, 3, 4, 5, 9}));
}

TEST(CrossValidationTest, AGainInEveryScanIsClearAndOneInOneScanIsNot) {
  std::vector<ScanCounts> base, better, lucky;
  std::vector<int> groups;
  for (int i = 0; i < 20; ++i) {
    groups.push_back(i);
    base.push_back(Counts(2, 2));
    better.push_back(Counts(3, 1));
    lucky.push_back(i == 4 ? Counts(4, 0) : Counts(2, 2));
  }
  const Gain clear = GainOf(base, better, groups, &F1, 1);
  EXPECT_TRUE(clear.clear());
  EXPECT_LE(clear.low, clear.value);
  EXPECT_GE(clear.high, clear.value);
  EXPECT_FALSE(GainOf(base, lucky, groups, &F1, 1).clear());
  EXPECT_FALSE(GainOf(base, base, groups, &F1, 1).clear());
  EXPECT_FALSE(GainOf(better, base, groups, &F1, 1).clear());
  EXPECT_FALSE(GainOf({}, {}, {}, &F1, 1).clear());
}

TEST(CrossValidationTest, ScansOfOneGroupAreOneObservation) {
  const std::vector<ScanCounts> base(20, Counts(2, 2));
  std::vector<ScanCounts> tuned = base;
  std::vector<int> groups(20);
  for (int i = 0; i < 20; ++i) groups[i] = i / 5;
  for (int i = 0; i < 5; ++i) tuned[i] = Counts(4, 0);
  EXPECT_FALSE(GainOf(base, tuned, groups, &F1, 1).clear());
}

// A parameter x in 0 .. 1: scans find most with x near their favourite.
class TunerTest : public testing::Test {
 protected:
  static TuningResult Tune(const std::vector<double>& favourites, int stop_after = 1'000'000) {
    Dimension x;
    x.name = "x";
    x.high = 1.0;
    int calls = 0;
    TrialStore store(static_cast<int>(favourites.size()),
                     [&](const Setting& setting, const std::vector<int>& scans) {
                       if (++calls > stop_after) throw std::runtime_error("stop");
                       std::vector<ScanCounts> counts;
                       for (const int scan : scans) {
                         const double off = std::abs(std::stod(setting[0]) - favourites[scan]);
                         const int right = static_cast<int>(1000.0 * std::max(0.0, 1.0 - off));
                         counts.push_back(Counts(right, 1000 - right));
                       }
                       return std::optional(counts);
                     });
    TuningPlan plan;
    plan.dimensions = {x};
    plan.start = {"0.2"};
    for (std::size_t i = 0; i < favourites.size(); ++i) {
      plan.groups.push_back(static_cast<int>(i));
      plan.folds.push_back(static_cast<int>(i) % 3);
    }
    plan.score = &F1;
    plan.begin_search = [](int, int) { return [](int settings) { return settings / 60.0; }; };
    Tuner tuner(plan, &store);
    try {
      tuner.Run();
    } catch (const std::runtime_error&) {
    }
    return tuner.result();
  }
};

TEST_F(TunerTest, WhatHoldsInAllScansIsAClearGainInUnseenOnes) {
  const TuningResult result = Tune(std::vector<double>(12, 0.7));
  ASSERT_TRUE(result.complete);
  EXPECT_TRUE(result.gain.clear());
  EXPECT_EQ(result.base_held_out.scans, 12);
  EXPECT_EQ(result.tuned_held_out.scans, 12);
  EXPECT_GT(result.tuned_held_out.right, 11900);
}

TEST_F(TunerTest, WhatHoldsInOneFoldOnlyIsNoGainInUnseenScans) {
  // Each fold's scans want something else: what the others want is no use to it.
  const TuningResult result = Tune({0.0, 0.2, 0.4, 0.0, 0.2, 0.4, 0.0, 0.2, 0.4, 0.0, 0.2, 0.4});
  ASSERT_TRUE(result.complete);
  EXPECT_FALSE(result.gain.clear());
}

TEST_F(TunerTest, BrokenOffItKnowsTheBestSoFar) {
  const TuningResult result = Tune(std::vector<double>(12, 0.7), 30);
  EXPECT_FALSE(result.complete);
  EXPECT_GE(result.best, 0);
  EXPECT_EQ(Tune(std::vector<double>(12, 0.7), 0).best, -1);
}

}  // namespace
}  // namespace rimod
