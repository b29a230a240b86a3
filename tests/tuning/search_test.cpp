#include "tuning/search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

namespace rimod {
namespace {

constexpr int kScans = 8;

Dimension Range(double low, double high) {
  Dimension dimension;
  dimension.low = low;
  dimension.high = high;
  return dimension;
}

// Counts whose F1 is 1 for cost 0 and falls with it; every scan tells the same.
std::vector<ScanCounts> CountsFor(double cost, std::size_t num_scans) {
  ScanCounts counts;
  counts.scans = 1;
  counts.right = static_cast<int>(10000.0 * std::exp(-cost));
  counts.missed = 10000 - counts.right;
  return std::vector<ScanCounts>(num_scans, counts);
}

struct Toy {
  std::vector<Dimension> dimensions;
  Setting start;
  std::function<double(const Setting&)> cost;  // negative: not valid
  int num_settings = 200;
  std::uint64_t seed = 1;

  struct Found {
    Setting best;
    int num_settings = 0;
    std::vector<Setting> tried;
    int scans_used = 0;
  };
  Found Run() const {
    Found found;
    TrialStore store(kScans,
                     [&](const Setting& setting,
                         const std::vector<int>& scans) -> std::optional<std::vector<ScanCounts>> {
                       found.tried.push_back(setting);
                       found.scans_used += static_cast<int>(scans.size());
                       const double value = cost(setting);
                       if (value < 0.0) return std::nullopt;
                       return CountsFor(value, scans.size());
                     });
    SearchTask task;
    task.dimensions = dimensions;
    task.start = start;
    task.scans.resize(kScans);
    std::iota(task.scans.begin(), task.scans.end(), 0);
    task.score = [](const ScanCounts& counts) { return ObjectiveFrom("f1")->Score(counts); };
    task.spent = [most = num_settings](int settings) { return settings / double(most); };
    task.seed = seed;
    Search search(task, &store);
    search.Run();
    found.best = store.trials()[search.best()].setting;
    found.num_settings = search.num_settings();
    return found;
  }
};

// A bowl with its bottom at (0.03, 7).
Toy Bowl() {
  Toy toy;
  toy.dimensions = {Range(0.01, 1.0), Range(-10.0, 10.0)};
  toy.start = {"0.5", "-5"};
  toy.cost = [](const Setting& setting) {
    const double a = std::log(std::stod(setting[0]) / 0.03);
    const double b = (std::stod(setting[1]) - 7.0) / 10.0;
    return a * a + b * b;
  };
  return toy;
}

TEST(SearchTest, FindsTheBottomOfABowl) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Toy toy = Bowl();
    toy.seed = seed;
    const Setting best = toy.Run().best;
    EXPECT_NEAR(std::log(std::stod(best[0]) / 0.03), 0.0, 0.2);
    EXPECT_NEAR(std::stod(best[1]), 7.0, 1.0);
  }
}

TEST(SearchTest, FindsTheBestOfListsAndThenEnds) {
  Toy toy;
  Dimension words;
  words.values = {"a", "b", "c"};
  Dimension whole = Range(1.0, 4.0);
  whole.whole = true;
  toy.dimensions = {words, whole};
  toy.start = {"a", "1"};
  toy.cost = [](const Setting& setting) {
    return (setting[0] == "b" ? 0.0 : 1.0) + std::abs(std::stod(setting[1]) - 3.0);
  };
  toy.num_settings = 1'000'000;
  const Toy::Found found = toy.Run();
  EXPECT_EQ(found.best, (Setting{"b", "3"}));
  EXPECT_EQ(found.num_settings, 12);
}

TEST(SearchTest, RespectsBudgetAndRanges) {
  for (const int budget : {1, 2, 9, 50}) {
    Toy toy = Bowl();
    toy.num_settings = budget;
    const Toy::Found found = toy.Run();
    EXPECT_LE(found.num_settings, budget);
    for (const Setting& setting : found.tried) {
      EXPECT_GE(std::stod(setting[0]), 0.01);
      EXPECT_LE(std::stod(setting[0]), 1.0);
      EXPECT_LE(std::abs(std::stod(setting[1])), 10.0);
    }
  }
}

TEST(SearchTest, TheSeedAloneDecides) {
  Toy toy = Bowl();
  const Toy::Found first = toy.Run();
  EXPECT_EQ(first.tried, toy.Run().tried);
  toy.seed = 2;
  EXPECT_NE(first.tried, toy.Run().tried);
}

TEST(SearchTest, HopelessSettingsAreNotTriedInAllScans) {
  const Toy::Found found = Bowl().Run();
  EXPECT_LT(found.scans_used, found.num_settings * kScans * 3 / 4);
}

TEST(SearchTest, InvalidSettingsAreSkipped) {
  Toy toy = Bowl();
  const auto bowl = toy.cost;
  toy.cost = [bowl](const Setting& setting) {
    return std::stod(setting[1]) > 2.0 ? -1.0 : bowl(setting);
  };
  const Setting best = toy.Run().best;
  EXPECT_LE(std::stod(best[1]), 2.0);
  EXPECT_GE(std::stod(best[1]), 0.0);
  toy.cost = [](const Setting&) { return -1.0; };
  EXPECT_THROW(toy.Run(), std::invalid_argument);
}

TEST(SearchTest, WhatIsOnlyAsGoodDoesNotReplaceTheStart) {
  Toy toy = Bowl();
  toy.cost = [](const Setting&) { return 0.5; };
  EXPECT_EQ(toy.Run().best, toy.start);
}

TEST(SearchTest, AStartOutsideTheRangesMayStay) {
  Toy toy = Bowl();
  toy.start = {"3", "-5"};
  toy.cost = [](const Setting& setting) { return setting[0] == "3" ? 0.0 : 1.0; };
  EXPECT_EQ(toy.Run().best, toy.start);
}

TEST(TrialStoreTest, NothingIsComputedTwice) {
  int num_scans = 0;
  TrialStore store(4, [&](const Setting&, const std::vector<int>& scans) {
    num_scans += static_cast<int>(scans.size());
    return std::optional(CountsFor(0.0, scans.size()));
  });
  const int trial = store.Add({"1"});
  EXPECT_EQ(store.Add({"1"}), trial);
  EXPECT_TRUE(store.Measure(trial, {0, 1}));
  EXPECT_TRUE(store.Measure(trial, {1, 0, 3}));
  EXPECT_EQ(num_scans, 3);
  EXPECT_EQ(store.Sum(trial, {0, 3}).scans, 2);
}

}  // namespace
}  // namespace rimod
