#include "tuning/objective.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rimod {
namespace {

ScanCounts Counts(int right, int false_alarms, int missed) {
  ScanCounts counts;
  counts.scans = 2;
  counts.right = counts.posed = right;
  counts.false_alarms = false_alarms;
  counts.missed = missed;
  return counts;
}

double Score(const std::string& name, const ScanCounts& counts) {
  return ObjectiveFrom(name).value().Score(counts);
}

TEST(ObjectiveTest, FOfHandMadeCounts) {
  EXPECT_DOUBLE_EQ(Score("f1", Counts(6, 2, 4)), 12.0 / 18.0);
  EXPECT_DOUBLE_EQ(Score("f2", Counts(6, 2, 4)), 30.0 / 48.0);
  EXPECT_DOUBLE_EQ(Score("f0.5", Counts(6, 2, 4)), 7.5 / 10.5);
  EXPECT_DOUBLE_EQ(Score("f1", Counts(5, 0, 0)), 1.0);
  EXPECT_DOUBLE_EQ(Score("f1", Counts(0, 0, 0)), 0.0);
}

TEST(ObjectiveTest, BetaSaysWhetherFalseAlarmsOrMissesWeighMore) {
  EXPECT_GT(Score("f0.5", Counts(6, 2, 4)), Score("f0.5", Counts(6, 4, 2)));
  EXPECT_LT(Score("f2", Counts(6, 2, 4)), Score("f2", Counts(6, 4, 2)));
}

TEST(ObjectiveTest, AWrongPoseIsAMissAndAFalseAlarm) {
  ScanCounts counts = Counts(6, 2, 4);
  EXPECT_DOUBLE_EQ(Score("pose-f1", counts), Score("f1", counts));
  counts.posed = 4;
  EXPECT_DOUBLE_EQ(Score("pose-f1", counts), Score("f1", Counts(4, 4, 6)));
}

TEST(ObjectiveTest, ZetaIsThePapersAndFiniteWhenAllIsFound) {
  EXPECT_DOUBLE_EQ(Score("zeta", Counts(6, 2, 4)), 36.0 / 18.0);
  EXPECT_TRUE(std::isfinite(Score("zeta", Counts(6, 0, 0))));
  EXPECT_GT(Score("zeta", Counts(6, 0, 0)), Score("zeta", Counts(6, 1, 0)));
}

TEST(ObjectiveTest, RecallCountsOnlyWherePrecisionIsEnough) {
  EXPECT_DOUBLE_EQ(Score("recall@0.75", Counts(6, 2, 4)), 0.6);
  EXPECT_DOUBLE_EQ(Score("recall@0.8", Counts(6, 2, 4)), 0.75 - 0.8);
  EXPECT_LT(Score("recall@0.9", Counts(90, 11, 0)), Score("recall@0.9", Counts(1, 0, 99)));
}

TEST(ObjectiveTest, WhatTakesTooLongIsWorseThanAnythingElse) {
  Objective objective = *ObjectiveFrom("f1");
  ScanCounts slow = Counts(9, 0, 0);
  slow.ms = 400.0;
  EXPECT_DOUBLE_EQ(objective.Score(slow), 1.0);
  objective.max_ms = 100.0;
  EXPECT_LT(objective.Score(slow), objective.Score(Counts(0, 9, 9)));
}

TEST(ObjectiveTest, OtherNamesAreNone) {
  for (const char* name : {"", "f", "f0", "f-1", "fnan", "f1x", "pose-f", "recall@", "recall@1.1",
                           "recall@nan", "Zeta", "precision"})
    EXPECT_FALSE(ObjectiveFrom(name)) << name;
}

}  // namespace
}  // namespace rimod
