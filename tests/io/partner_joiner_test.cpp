#include "io/partner_joiner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "io/shard_messages.h"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

using std::chrono::milliseconds;

class PartnerJoinerTest : public ::testing::Test {
 protected:
  // Scan number k of a utime: an image and its features. Each tells the utime, too.
  const DescribedScan& ScanOf(std::int64_t utime, int k = 0) {
    const auto [scan, is_new] = scans_.emplace(std::pair(utime, k), DescribedScan());
    if (is_new) {
      scan->second.image = random_.AnImage(static_cast<int>(utime), 20);
      scan->second.features = random_.FeaturesOf(scan->second.image, static_cast<int>(utime), 2);
    }
    return scan->second;
  }
  std::optional<DescribedScan> AddImage(std::int64_t utime, int k = 0) {
    return joiner_.AddImage(utime, ScanOf(utime, k).image, now_);
  }
  std::optional<DescribedScan> AddFeatures(std::int64_t utime, int k = 0) {
    return joiner_.AddFeatures(utime, ScanOf(utime, k).features, now_);
  }
  static void ExpectScan(const std::optional<DescribedScan>& scan, std::int64_t utime) {
    ASSERT_TRUE(scan);
    EXPECT_EQ(scan->utime, utime);
    EXPECT_EQ(scan->image.width(), utime);
    EXPECT_EQ(scan->features.features.size(), static_cast<std::size_t>(utime));
  }

  RandomValues random_{1};
  std::map<std::pair<std::int64_t, int>, DescribedScan> scans_;
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

TEST_F(PartnerJoinerTest, ASecondImageOfTheSameScanIsLeftWithoutPartner) {
  EXPECT_FALSE(AddImage(5));
  EXPECT_FALSE(AddImage(5));
  ExpectScan(AddFeatures(5), 5);
  now_ += milliseconds(1001);
  joiner_.GiveUpStale(now_);
  EXPECT_EQ(joiner_.num_unpaired(), 1);
  EXPECT_EQ(joiner_.num_refused(), 0);
}

// Images and features of two scans with one utime, in every order and with each of them lost: each
// scan that is there comes out, with what belongs to it.
TEST_F(PartnerJoinerTest, TwoScansOfOneUtimeAreToldApartByWhatTheyHold) {
  for (unsigned lost = 0; lost < 16; ++lost) {
    std::vector<int> parts;  // image 0, image 1, features 0, features 1
    for (int part = 0; part < 4; ++part)
      if (!(lost >> part & 1u)) parts.push_back(part);
    do {
      PartnerJoiner joiner{milliseconds(1000)};
      std::set<int> paired;
      for (const int part : parts) {
        const DescribedScan& scan = ScanOf(5, part % 2);
        const auto pair = part < 2 ? joiner.AddImage(5, scan.image, now_)
                                   : joiner.AddFeatures(5, scan.features, now_);
        if (!pair) continue;
        paired.insert(part % 2);
        EXPECT_EQ(DigestOf(*pair), DigestOf(DescribedScan{5, scan.image, scan.features}));
      }
      std::set<int> whole;
      for (const int k : {0, 1})
        if (std::count(parts.begin(), parts.end(), k) &&
            std::count(parts.begin(), parts.end(), k + 2))
          whole.insert(k);
      EXPECT_EQ(paired, whole);
      joiner.GiveUpStale(now_ + milliseconds(1001));
      EXPECT_EQ(joiner.num_unpaired(), static_cast<std::int64_t>(parts.size() - 2 * whole.size()));
      if (parts == std::vector<int>{0, 3} || parts == std::vector<int>{3, 0}) {
        EXPECT_EQ(joiner.num_refused(), 1);
        EXPECT_EQ(joiner.refused_utime(), 5);
      }
    } while (std::next_permutation(parts.begin(), parts.end()));
  }
}

// They say nothing about the image that they are of.
TEST_F(PartnerJoinerTest, AnEmptyFeatureSetIsPairedOnlyWhereOneImageWaits) {
  EXPECT_FALSE(AddImage(5, 0));
  EXPECT_TRUE(joiner_.AddFeatures(5, FeatureSet(), now_));
  EXPECT_FALSE(AddImage(6, 0));
  EXPECT_FALSE(AddImage(6, 1));
  EXPECT_FALSE(joiner_.AddFeatures(6, FeatureSet(), now_));
  EXPECT_TRUE(AddFeatures(6, 1));
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
