#include "io/partner_joiner.h"

#include <gtest/gtest.h>

#include "tests/io/random_values.h"

namespace rimod {
namespace {

using std::chrono::milliseconds;

class PartnerJoinerTest : public ::testing::Test {
 protected:
  // An image and features that tell which scan they are of.
  std::optional<DescribedScan> AddImage(std::int64_t utime) {
    return joiner_.AddImage(utime, random_.AnImage(static_cast<int>(utime), 1), now_);
  }
  std::optional<DescribedScan> AddFeatures(std::int64_t utime) {
    return joiner_.AddFeatures(utime, random_.Features(static_cast<int>(utime), 2), now_);
  }
  static void ExpectScan(const std::optional<DescribedScan>& scan, std::int64_t utime) {
    ASSERT_TRUE(scan);
    EXPECT_EQ(scan->utime, utime);
    EXPECT_EQ(scan->image.width(), utime);
    EXPECT_EQ(scan->features.features.size(), static_cast<std::size_t>(utime));
  }

  RandomValues random_{1};
  PartnerJoiner joiner_{milliseconds(1000)};
  PartnerJoiner::Time now_{};
};

TEST_F(PartnerJoinerTest, EitherMayComeFirst) {
  EXPECT_FALSE(AddImage(5));
  ExpectScan(AddFeatures(5), 5);
  EXPECT_FALSE(AddFeatures(6));
  ExpectScan(AddImage(6), 6);
  EXPECT_EQ(joiner_.num_unpaired(), 0);
}

TEST_F(PartnerJoinerTest, PartnersOfDifferentScansAreNotMixed) {
  EXPECT_FALSE(AddImage(5));
  EXPECT_FALSE(AddFeatures(6));
  EXPECT_FALSE(AddImage(7));
  ExpectScan(AddFeatures(5), 5);
  ExpectScan(AddImage(6), 6);
}

TEST_F(PartnerJoinerTest, AScanThatIsReplayedIsJoinedAgain) {
  for (int i = 0; i < 2; ++i) {
    EXPECT_FALSE(AddImage(5));
    ExpectScan(AddFeatures(5), 5);
  }
}

TEST_F(PartnerJoinerTest, ASecondOneTakesThePlaceOfTheFirst) {
  EXPECT_FALSE(AddImage(5));
  EXPECT_FALSE(AddImage(5));
  ExpectScan(AddFeatures(5), 5);
  EXPECT_EQ(joiner_.num_unpaired(), 1);
}

TEST_F(PartnerJoinerTest, WhoWaitsTooLongIsGivenUp) {
  AddImage(5);
  now_ += milliseconds(1001);
  joiner_.GiveUpStale(now_);
  EXPECT_EQ(joiner_.num_unpaired(), 1);
  EXPECT_FALSE(AddFeatures(5));
}

TEST_F(PartnerJoinerTest, OnlySoManyWait) {
  for (std::int64_t utime = 1; utime <= 100; ++utime) AddImage(utime);
  EXPECT_EQ(joiner_.num_unpaired(), 92);
  ExpectScan(AddFeatures(93), 93);
  EXPECT_FALSE(AddFeatures(92));
}

}  // namespace
}  // namespace rimod
