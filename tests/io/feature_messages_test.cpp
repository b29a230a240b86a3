#include "io/feature_messages.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "io/message_codec.h"
#include "tests/io/random_values.h"
#include "tests/support/same_features.h"

namespace rimod {
namespace {

std::vector<feature_set_t> ThroughBytes(const std::vector<feature_set_t>& sections) {
  std::vector<feature_set_t> received;
  for (const feature_set_t& section : sections) {
    const std::vector<std::uint8_t> bytes = EncodeMessage(section);
    EXPECT_LE(bytes.size(), static_cast<std::size_t>(kSectionBytes));
    received.push_back(DecodeMessage<feature_set_t>(bytes.data(), bytes.size()).message.value());
  }
  return received;
}

TEST(FeatureMessagesTest, SetsOfAnySizeComeBackBitForBit) {
  RandomValues random(1);
  for (const auto& [number, size] :
       {std::pair(0, 64), std::pair(1, 64), std::pair(393, 64), std::pair(394, 64),
        std::pair(395, 64), std::pair(3000, 64), std::pair(5, 0), std::pair(30, 4096)}) {
    const FeatureSet features = random.Features(number, size);
    const JoinedFeatures joined = JoinFeatureSections(ThroughBytes(ToSections(features, 3)));
    ASSERT_TRUE(joined.features) << joined.error;
    ExpectEqual(*joined.features, features);
  }
}

TEST(FeatureMessagesTest, ALongNameOfTheKindStillFits) {
  RandomValues random(2);
  FeatureSet features = random.Features(1500, 64);
  features.descriptor_kind = std::string(kMaxDescriptorKindBytes, 'k');
  const JoinedFeatures joined = JoinFeatureSections(ThroughBytes(ToSections(features, 3)));
  ASSERT_TRUE(joined.features) << joined.error;
  ExpectEqual(*joined.features, features);
}

TEST(FeatureMessagesTest, AnInvalidSetIsNotSent) {
  RandomValues random(3);
  FeatureSet odd = random.Features(5, 64);
  odd.features[3].descriptor.pop_back();
  EXPECT_THROW(ToSections(odd, 0), std::invalid_argument);
  EXPECT_THROW(ToSections(random.Features(1, kMaxDescriptorSize + 1), 0), std::invalid_argument);
  FeatureSet long_kind = random.Features(1, 4);
  long_kind.descriptor_kind = std::string(kMaxDescriptorKindBytes + 1, 'k');
  EXPECT_THROW(ToSections(long_kind, 0), std::invalid_argument);
}

class BadFeaturesTest : public ::testing::Test {
 protected:
  BadFeaturesTest() {
    RandomValues random(4);
    good_ = ToSections(random.Features(900, 64), 1);
    bad_ = good_;
  }
  template <typename Change>
  void ChangeAll(const Change& change) {
    for (feature_set_t& section : bad_) change(&section);
  }
  void ExpectRejected(const std::string& error) {
    ASSERT_GE(good_.size(), 3u);
    EXPECT_TRUE(JoinFeatureSections(good_).features);
    const JoinedFeatures joined = JoinFeatureSections(bad_);
    EXPECT_FALSE(joined.features);
    EXPECT_EQ(joined.error, error);
  }
  std::vector<feature_set_t> good_;
  std::vector<feature_set_t> bad_;
};

TEST_F(BadFeaturesTest, NoSections) {
  bad_.clear();
  ExpectRejected("no sections");
}
TEST_F(BadFeaturesTest, MissingSection) {
  bad_.erase(bad_.begin());
  ExpectRejected("sections are not in order or not complete");
}
TEST_F(BadFeaturesTest, SectionOfAnotherKind) {
  bad_[2].descriptor = "another";
  ExpectRejected("sections are of different feature sets");
}
TEST_F(BadFeaturesTest, OtherUnit) {
  ChangeAll([](feature_set_t* s) { s->descriptor_unit = 0.001; });
  ExpectRejected("descriptors in another unit than ours");
}
TEST_F(BadFeaturesTest, NegativeDescriptorSize) {
  ChangeAll([](feature_set_t* s) { s->descriptor_size = -64; });
  ExpectRejected("absurd kind of descriptor");
}
TEST_F(BadFeaturesTest, HugeDescriptorSize) {
  ChangeAll([](feature_set_t* s) { s->descriptor_size = 2000000000; });
  ExpectRejected("absurd kind of descriptor");
}
TEST_F(BadFeaturesTest, DescriptorSizeThatDoesNotFit) {
  ChangeAll([](feature_set_t* s) { s->descriptor_size = 63; });
  ExpectRejected("a count does not fit its list");
}
TEST_F(BadFeaturesTest, NegativeCount) {
  bad_[1].num_features = -1;
  ExpectRejected("a count is negative");
}
TEST_F(BadFeaturesTest, CountThatDoesNotFit) {
  bad_[1].num_features += 1;
  ExpectRejected("a count does not fit its list");
}
TEST_F(BadFeaturesTest, TooFewValues) {
  bad_[1].values.pop_back();
  ExpectRejected("a count does not fit its list");
}
TEST_F(BadFeaturesTest, PositionNotFinite) {
  bad_[1].y[5] = std::numeric_limits<float>::quiet_NaN();
  ExpectRejected("a feature's position is not finite");
}
TEST_F(BadFeaturesTest, NormalWithoutLength) {
  bad_[1].normal_x[5] = bad_[1].normal_y[5] = bad_[1].normal_z[5] = 0.0f;
  ExpectRejected("a feature's normal is not a unit vector");
}

}  // namespace
}  // namespace rimod
