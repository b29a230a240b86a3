#include "io/range_image_messages.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "io/message_codec.h"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

std::vector<range_image_t> ThroughBytes(const std::vector<range_image_t>& sections,
                                        std::size_t max_bytes) {
  std::vector<range_image_t> received;
  for (const range_image_t& section : sections) {
    const std::vector<std::uint8_t> bytes = EncodeMessage(section);
    EXPECT_LE(bytes.size(), max_bytes);
    received.push_back(DecodeMessage<range_image_t>(bytes.data(), bytes.size()).message.value());
  }
  return received;
}

void ExpectEqual(const RangeImage& a, const RangeImage& b) {
  ASSERT_TRUE(a.grid() == b.grid());
  EXPECT_EQ(a.T_local_sensor().matrix(), b.T_local_sensor().matrix());
  int num_different = 0;
  for (int row = 0; row < a.height(); ++row) {
    for (int column = 0; column < a.width(); ++column) {
      const bool equal = a.pixel(row, column) == b.pixel(row, column) &&
                         a.range(row, column) == b.range(row, column) &&
                         a.point(row, column) == b.point(row, column);
      num_different += equal ? 0 : 1;
    }
  }
  EXPECT_EQ(num_different, 0);
}

TEST(RangeImageMessagesTest, ImagesOfAnySizeComeBackBitForBit) {
  RandomValues random(1);
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(450, 225), std::pair(3, 440),
                                      std::pair(890, 1), std::pair(899, 448)}) {
    const RangeImage image = random.AnImage(width, height);
    const JoinedRangeImage joined =
        JoinRangeImageSections(ThroughBytes(ToSections(image, 7), kSectionBytes));
    ASSERT_TRUE(joined.image) << joined.error;
    ExpectEqual(*joined.image, image);
  }
}

TEST(RangeImageMessagesTest, PinholeImagesComeBackBitForBit) {
  RandomValues random(2);
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(320, 240), std::pair(3, 440)}) {
    const RangeImage image = random.AnImage(width, height, Projection::kPinhole);
    const std::vector<range_image_t> sections = ToSections(image, 7);
    EXPECT_EQ(sections[0].projection, range_image_t::PINHOLE);
    const JoinedRangeImage joined = JoinRangeImageSections(ThroughBytes(sections, kSectionBytes));
    ASSERT_TRUE(joined.image) << joined.error;
    ExpectEqual(*joined.image, image);
  }
}

TEST(RangeImageMessagesTest, AnImageOfSizeZeroComesBack) {
  const std::vector<range_image_t> sections = ToSections(RangeImage(), 5);
  ASSERT_EQ(sections.size(), 1u);
  EXPECT_EQ(sections[0].utime, 5);
  const JoinedRangeImage joined = JoinRangeImageSections(ThroughBytes(sections, kSectionBytes));
  ASSERT_TRUE(joined.image) << joined.error;
  EXPECT_EQ(joined.image->width(), 0);
  EXPECT_EQ(joined.image->height(), 0);
}

TEST(RangeImageMessagesTest, TheWidestRowFitsIntoAMessage) {
  PixelGrid grid;
  grid.width = kMaxRangeImageWidth;
  grid.height = 2;
  grid.resolution = 2.0 * M_PI / kMaxRangeImageWidth;
  grid.left = M_PI;
  const RangeImage image(grid, Eigen::Isometry3d::Identity());
  const JoinedRangeImage joined =
      JoinRangeImageSections(ThroughBytes(ToSections(image, 0), kMaxMessageBytes));
  ASSERT_TRUE(joined.image) << joined.error;
  ExpectEqual(*joined.image, image);

  grid.width = kMaxRangeImageWidth + 1;
  EXPECT_THROW(ToSections(RangeImage(grid, Eigen::Isometry3d::Identity()), 0),
               std::invalid_argument);
}

class BadRangeImageTest : public ::testing::Test {
 protected:
  BadRangeImageTest() {
    RandomValues random(2);
    good_ = ToSections(random.AnImage(300, 120), 1);
    bad_ = good_;
  }
  template <typename Change>
  void ChangeAll(const Change& change) {
    for (range_image_t& section : bad_) change(&section);
  }
  void ExpectRejected(const std::string& error) {
    ASSERT_GE(good_.size(), 3u);
    EXPECT_TRUE(JoinRangeImageSections(good_).image);
    const JoinedRangeImage joined = JoinRangeImageSections(bad_);
    EXPECT_FALSE(joined.image);
    EXPECT_EQ(joined.error, error);
  }
  std::vector<range_image_t> good_;
  std::vector<range_image_t> bad_;
};

TEST_F(BadRangeImageTest, NoSections) {
  bad_.clear();
  ExpectRejected("no sections");
}
TEST_F(BadRangeImageTest, MissingSection) {
  bad_.erase(bad_.begin() + 1);
  ExpectRejected("sections are not in order or not complete");
}
TEST_F(BadRangeImageTest, SectionOfAnotherImage) {
  bad_[1].azimuth_left += 0.1;
  ExpectRejected("sections are of different images");
}
TEST_F(BadRangeImageTest, HugeSize) {
  ChangeAll([](range_image_t* s) { s->width = s->height = 2000000000; });
  ExpectRejected("absurd image size");
}
TEST_F(BadRangeImageTest, NegativeSize) {
  ChangeAll([](range_image_t* s) { s->height = -120; });
  ExpectRejected("absurd image size");
}
TEST_F(BadRangeImageTest, MoreRowsPromisedThanSent) {
  ChangeAll([](range_image_t* s) { s->height += 1; });
  ExpectRejected("rows are missing or there twice");
}
TEST_F(BadRangeImageTest, RowTwice) {
  bad_[1].first_row -= 1;
  ExpectRejected("rows are missing or there twice");
}
TEST_F(BadRangeImageTest, PartOfARow) {
  bad_[0].range.pop_back();
  bad_[0].offset_azimuth.pop_back();
  bad_[0].offset_elevation.pop_back();
  bad_[0].num_pixels -= 1;
  ExpectRejected("pixels are not whole rows");
}
TEST_F(BadRangeImageTest, CountThatDoesNotFit) {
  bad_[0].num_pixels += 1;
  ExpectRejected("a count does not fit its list");
}
TEST_F(BadRangeImageTest, NegativeCount) {
  bad_[0].num_pixels = -1;
  ExpectRejected("a count does not fit its list");
}
TEST_F(BadRangeImageTest, NegativeRows) {
  bad_[0].num_rows = -bad_[0].num_rows;
  ExpectRejected("pixels are not whole rows");
}
TEST_F(BadRangeImageTest, OtherRangeUnit) {
  ChangeAll([](range_image_t* s) { s->range_unit = 0.002; });
  ExpectRejected("ranges in another unit than ours");
}
TEST_F(BadRangeImageTest, ResolutionNotANumber) {
  ChangeAll([](range_image_t* s) { s->resolution = std::numeric_limits<double>::quiet_NaN(); });
  ExpectRejected("absurd resolution");
}
TEST_F(BadRangeImageTest, ResolutionZero) {
  ChangeAll([](range_image_t* s) { s->resolution = 0.0; });
  ExpectRejected("absurd resolution");
}
TEST_F(BadRangeImageTest, WiderThanASphere) {
  ChangeAll([](range_image_t* s) { s->resolution = 0.1; });
  ExpectRejected("image is wider than a sphere");
}
TEST_F(BadRangeImageTest, EdgeNotFinite) {
  ChangeAll([](range_image_t* s) { s->elevation_top = std::numeric_limits<double>::infinity(); });
  ExpectRejected("absurd image edges");
}
TEST_F(BadRangeImageTest, ResolutionTiny) {
  ChangeAll([](range_image_t* s) { s->resolution = 1e-300; });
  ExpectRejected("absurd resolution");
}
TEST_F(BadRangeImageTest, UnknownProjection) {
  ChangeAll([](range_image_t* s) { s->projection = 2; });
  ExpectRejected("unknown projection");
  ChangeAll([](range_image_t* s) { s->projection = -1; });
  ExpectRejected("unknown projection");
}
TEST_F(BadRangeImageTest, SphericalWithAnAxis) {
  ChangeAll([](range_image_t* s) { s->axis_elevation = -0.1; });
  ExpectRejected("spherical image with an axis");
}
TEST_F(BadRangeImageTest, AxisAbsurd) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -7.0}) {
    for (double range_image_t::*field :
         {&range_image_t::axis_azimuth, &range_image_t::axis_elevation}) {
      ChangeAll([&](range_image_t* s) {
        s->projection = range_image_t::PINHOLE;
        s->axis_azimuth = s->axis_elevation = 0.0;
        s->*field = value;
      });
      ExpectRejected("absurd axis");
    }
  }
}
TEST_F(BadRangeImageTest, SectionsOfTwoProjections) {
  bad_.back().projection = range_image_t::PINHOLE;
  ExpectRejected("sections are of different images");
}
TEST_F(BadRangeImageTest, WiderThanAPinholes) {
  ChangeAll([](range_image_t* s) {
    s->projection = range_image_t::PINHOLE;
    s->resolution = 0.1;
  });
  ExpectRejected("image is wider than a pinhole's");
}
TEST_F(BadRangeImageTest, APinholesEdgesFarOffItsAxis) {
  for (double range_image_t::*edge :
       {&range_image_t::azimuth_left, &range_image_t::elevation_top}) {
    for (const double value : {5.0, -3.9}) {
      bad_ = good_;
      ChangeAll([&](range_image_t* s) {
        s->projection = range_image_t::PINHOLE;
        s->resolution = 0.001;
        s->azimuth_left = s->elevation_top = 1.0;
      });
      EXPECT_TRUE(JoinRangeImageSections(bad_).image);
      ChangeAll([&](range_image_t* s) { s->*edge = value; });
      ExpectRejected("image is wider than a pinhole's");
    }
  }
}
TEST_F(BadRangeImageTest, SensorPoseNotFinite) {
  ChangeAll(
      [](range_image_t* s) { s->sensor_position[2] = std::numeric_limits<double>::quiet_NaN(); });
  ExpectRejected("sensor pose is not a pose");
}

}  // namespace
}  // namespace rimod
