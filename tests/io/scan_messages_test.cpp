#include "io/scan_messages.h"

#include <gtest/gtest.h>

#include <limits>

#include "io/message_codec.h"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

StampedScan AStampedScan(RandomValues* random, int num_points, int num_no_returns) {
  StampedScan scan;
  scan.utime = 1234567890123456;
  scan.utime_end = scan.utime + 9000000;
  scan.num_lines = 361;
  scan.num_missing_lines = 3;
  scan.scan = random->AScan(num_points, num_no_returns);
  return scan;
}

// Every section through its bytes, as over the network.
std::vector<scan_t> ThroughBytes(const std::vector<scan_t>& sections) {
  std::vector<scan_t> received;
  for (const scan_t& section : sections) {
    const std::vector<std::uint8_t> bytes = EncodeMessage(section);
    EXPECT_LE(bytes.size(), static_cast<std::size_t>(kSectionBytes));
    received.push_back(DecodeMessage<scan_t>(bytes.data(), bytes.size()).message.value());
  }
  return received;
}

void ExpectEqual(const StampedScan& a, const StampedScan& b) {
  EXPECT_EQ(a.utime, b.utime);
  EXPECT_EQ(a.utime_end, b.utime_end);
  EXPECT_EQ(a.num_lines, b.num_lines);
  EXPECT_EQ(a.num_missing_lines, b.num_missing_lines);
  EXPECT_EQ(a.scan.T_local_sensor.matrix(), b.scan.T_local_sensor.matrix());
  EXPECT_EQ(a.scan.points, b.scan.points);
  EXPECT_EQ(a.scan.no_return_directions, b.scan.no_return_directions);
}

TEST(ScanMessagesTest, ScansOfAnySizeComeBackBitForBit) {
  RandomValues random(1);
  for (const auto& [num_points, num_no_returns] :
       {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(4983, 0), std::pair(4984, 0),
        std::pair(4985, 0), std::pair(4980, 10), std::pair(0, 20000), std::pair(70000, 9000)}) {
    const StampedScan scan = AStampedScan(&random, num_points, num_no_returns);
    const JoinedScan joined = JoinScanSections(ThroughBytes(ToSections(scan)));
    ASSERT_TRUE(joined.scan) << joined.error;
    ExpectEqual(*joined.scan, scan);
  }
}

TEST(ScanMessagesTest, AnEmptyScanIsOneSection) {
  const std::vector<scan_t> sections = ToSections(StampedScan());
  ASSERT_EQ(sections.size(), 1u);
  EXPECT_EQ(sections[0].num_sections, 1);
  EXPECT_EQ(sections[0].num_points, 0);
}

class BadScanTest : public ::testing::Test {
 protected:
  BadScanTest() {
    RandomValues random(2);
    good_ = ToSections(AStampedScan(&random, 7000, 1000));
    bad_ = good_;
  }
  void ExpectRejected(const std::string& error) {
    EXPECT_TRUE(JoinScanSections(good_).scan);
    const JoinedScan joined = JoinScanSections(bad_);
    EXPECT_FALSE(joined.scan);
    EXPECT_EQ(joined.error, error);
  }
  std::vector<scan_t> good_;
  std::vector<scan_t> bad_;
};

TEST_F(BadScanTest, NoSections) {
  bad_.clear();
  ExpectRejected("no sections");
}
TEST_F(BadScanTest, MissingSection) {
  bad_.pop_back();
  ExpectRejected("sections are not in order or not complete");
}
TEST_F(BadScanTest, SwappedSections) {
  std::swap(bad_[0], bad_[1]);
  ExpectRejected("sections are not in order or not complete");
}
TEST_F(BadScanTest, SectionOfAnotherScan) {
  bad_[1].utime += 1;
  ExpectRejected("sections are of different scans");
}
TEST_F(BadScanTest, CountLargerThanList) {
  bad_[1].num_points += 1;
  ExpectRejected("a count does not fit its list");
}
TEST_F(BadScanTest, NegativeCount) {
  bad_[1].num_no_returns = -1;
  ExpectRejected("a count does not fit its list");
}
TEST_F(BadScanTest, ListsOfDifferentLengths) {
  bad_[0].y.pop_back();
  ExpectRejected("a count does not fit its list");
}
TEST_F(BadScanTest, PointNotFinite) {
  bad_[0].z[17] = std::numeric_limits<float>::quiet_NaN();
  ExpectRejected("a point is not finite");
}
TEST_F(BadScanTest, DirectionWithoutLength) {
  scan_t& last = bad_.back();
  last.no_return_x[0] = last.no_return_y[0] = last.no_return_z[0] = 0.0f;
  ExpectRejected("a direction without return is not a unit vector");
}
TEST_F(BadScanTest, DirectionNotFinite) {
  bad_.back().no_return_x[0] = std::numeric_limits<float>::infinity();
  ExpectRejected("a direction without return is not a unit vector");
}
TEST_F(BadScanTest, SensorPoseWithoutOrientation) {
  for (scan_t& section : bad_) {
    for (double& value : section.sensor_orientation) value = 0.0;
  }
  ExpectRejected("sensor pose is not a pose");
}
TEST_F(BadScanTest, EndBeforeBegin) {
  for (scan_t& section : bad_) section.utime_end = section.utime - 1;
  ExpectRejected("scan ends before it begins");
}
TEST_F(BadScanTest, NegativeNumberOfLines) {
  for (scan_t& section : bad_) section.num_missing_lines = -1;
  ExpectRejected("negative number of lines");
}

}  // namespace
}  // namespace rimod
