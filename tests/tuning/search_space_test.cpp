#include "tuning/search_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rimod {
namespace {

Dimension Range(double low, double high, bool whole = false) {
  Dimension dimension;
  dimension.low = low;
  dimension.high = high;
  dimension.whole = whole;
  return dimension;
}

TEST(SearchSpaceTest, ValuesStayWithinTheRangeAndReachItsEnds) {
  std::mt19937 random(1);
  for (const Dimension& dimension : {Range(0.05, 0.2), Range(1.0 / 3.0, 0.5), Range(-2.0, 3.0),
                                     Range(6, 10, true), Range(5, 5000, true), Range(0.001, 7.0)}) {
    for (int i = 0; i < 300; ++i) {
      const double place = std::uniform_real_distribution<double>(-0.2, 1.2)(random);
      const double value = std::stod(dimension.ValueAt(place));
      EXPECT_GE(value, dimension.low * (dimension.low > 0 ? 0.995 : 1.005));
      EXPECT_LE(value, dimension.high * 1.005);
      EXPECT_TRUE(!dimension.whole || value == std::round(value)) << value;
    }
    EXPECT_NEAR(std::stod(dimension.ValueAt(0.0)), dimension.low, 0.005 * std::abs(dimension.low));
    EXPECT_NEAR(std::stod(dimension.ValueAt(1.0)), dimension.high, 0.005 * dimension.high);
  }
}

TEST(SearchSpaceTest, PlaceOfIsWhereTheValueComesFrom) {
  Dimension list;
  list.values = {"false", "true", "maybe"};
  for (const Dimension& dimension :
       {Range(0.05, 0.2), Range(-2.0, 3.0), Range(6, 10, true), Range(5, 5000, true), list}) {
    for (double place = 0.0; place <= 1.0; place += 0.01) {
      const std::string value = dimension.ValueAt(place);
      EXPECT_EQ(dimension.ValueAt(dimension.PlaceOf(value)), value);
    }
  }
}

TEST(SearchSpaceTest, FarEndsAreVariedByFactors) {
  EXPECT_EQ(Range(0.01, 1.0).ValueAt(0.5), "0.1");
  EXPECT_EQ(Range(1.0, 2.0).ValueAt(0.5), "1.5");
}

TEST(SearchSpaceTest, ParsesRangesListsAndNames) {
  const std::optional<VaryText> range = ParseVaryText("a.b=-0.5..1e2");
  ASSERT_TRUE(range);
  EXPECT_EQ(range->name, "a.b");
  EXPECT_EQ(range->low, "-0.5");
  EXPECT_EQ(range->high, "1e2");
  const std::optional<VaryText> list = ParseVaryText("a.b=x,y,z");
  ASSERT_TRUE(list);
  EXPECT_EQ(list->values, (std::vector<std::string>{"x", "y", "z"}));
  ASSERT_TRUE(ParseVaryText("a.b"));
  for (const char* bad : {"", "=1..2", "a=", "a=1..", "a=..2", "a=1,,2", "a=,1", "a=1,"})
    EXPECT_FALSE(ParseVaryText(bad)) << bad;
}

}  // namespace
}  // namespace rimod
