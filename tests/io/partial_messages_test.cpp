#include "io/partial_messages.h"

#include <gtest/gtest.h>

#include "io/message_codec.h"
#include "io/section_joiner.h"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

SweepGrowth Growth(int num_points) {
  SweepGrowth growth;
  growth.sweep_begin = Time(1000);
  growth.step = 3;
  growth.begin = Time(2000);
  growth.end = Time(3000);
  growth.num_lines = 37;
  growth.scan = RandomValues(1).AScan(num_points, 200);
  return growth;
}

std::vector<scan_t> InnerSections(const std::vector<partial_scan_t>& partials) {
  std::vector<scan_t> sections;
  for (const partial_scan_t& partial : partials) sections.push_back(partial.section);
  return sections;
}

TEST(PartialMessagesTest, GrowthComesBackBitForBit) {
  for (const int num_points : {0, 10, 12000}) {
    const SweepGrowth growth = Growth(num_points);
    const std::vector<partial_scan_t> partials = ToPartialSections(growth);
    for (const partial_scan_t& partial : partials) {
      EXPECT_EQ(partial.utime, 1000);
      EXPECT_EQ(partial.step, 3);
      EXPECT_LE(EncodeMessage(partial).size(), 65000u);  // one datagram
    }
    const JoinedSweepGrowth back = SweepGrowthFrom(1000, 3, InnerSections(partials));
    ASSERT_TRUE(back.growth) << back.error;
    EXPECT_EQ(back.growth->sweep_begin, growth.sweep_begin);
    EXPECT_EQ(back.growth->step, growth.step);
    EXPECT_EQ(back.growth->begin, growth.begin);
    EXPECT_EQ(back.growth->end, growth.end);
    EXPECT_EQ(back.growth->num_lines, growth.num_lines);
    EXPECT_EQ(back.growth->scan.points, growth.scan.points);
    EXPECT_EQ(back.growth->scan.no_return_directions, growth.scan.no_return_directions);
    EXPECT_EQ(back.growth->scan.T_local_sensor.matrix(), growth.scan.T_local_sensor.matrix());
  }
}

TEST(PartialMessagesTest, WrongGrowthIsNamed) {
  const std::vector<scan_t> sections = InnerSections(ToPartialSections(Growth(10)));
  EXPECT_EQ(SweepGrowthFrom(2001, 3, sections).error, "grows before its sweep begins");
  EXPECT_EQ(SweepGrowthFrom(1000, -1, sections).error, "has a negative step");
  EXPECT_NE(SweepGrowthFrom(1000, 3, {}).error, "");
}

Sweep EndedSweep(int num_lines_of_rest) {
  Sweep sweep;
  sweep.begin = Time(1000);
  sweep.end = Time(5000);
  sweep.num_lines = 361;
  sweep.num_missing_lines = 2;
  sweep.scan = RandomValues(2).AScan(300, 20);
  sweep.rest = Growth(10);
  sweep.rest->step = 4;
  sweep.rest->num_lines = num_lines_of_rest;
  return sweep;
}

TEST(PartialMessagesTest, TheEndOfASweepTellsWhatAllGrowthsAre) {
  const Sweep sweep = EndedSweep(3);
  const SweepEndFromMessage back = FromMessage(ToScanEnd(sweep));
  ASSERT_TRUE(back.end) << back.error;
  EXPECT_EQ(back.end->begin, sweep.begin);
  EXPECT_EQ(back.end->end, sweep.end);
  EXPECT_EQ(back.end->num_steps, 5);
  EXPECT_EQ(back.end->num_lines, sweep.num_lines);
  EXPECT_EQ(back.end->num_missing_lines, sweep.num_missing_lines);
  EXPECT_EQ(back.end->num_points, 300u);
  EXPECT_EQ(back.end->num_no_returns, 20u);
  EXPECT_EQ(back.end->T_local_sensor.matrix(), sweep.scan.T_local_sensor.matrix());
  EXPECT_EQ(ToScanEnd(EndedSweep(0)).num_steps, 4) << "the rest is no step when it is empty";
}

TEST(PartialMessagesTest, WrongEndsAreNamed) {
  const scan_end_t good = ToScanEnd(EndedSweep(3));
  const auto error = [&](auto change) {
    scan_end_t bad = good;
    change(&bad);
    return FromMessage(bad).error;
  };
  EXPECT_EQ(error([](scan_end_t* m) { m->utime_end = 999; }), "scan ends before it begins");
  EXPECT_EQ(error([](scan_end_t* m) { m->num_steps = 0; }), "a sweep of no steps");
  EXPECT_EQ(error([](scan_end_t* m) { m->sensor_orientation[0] = 5.0; }),
            "sensor pose is not a pose");
  for (std::int32_t scan_end_t::*const count :
       {&scan_end_t::num_lines, &scan_end_t::num_missing_lines, &scan_end_t::num_points,
        &scan_end_t::num_no_returns}) {
    EXPECT_EQ(error([&](scan_end_t* m) { m->*count = -1; }), "negative number of lines or points");
  }
}

TEST(PartialMessagesTest, ImagesAndFeaturesAreThoseOfScansNamedByTheLastBeam) {
  const RangeImage image = RandomValues(1).AnImage(400, 200);
  const auto images = ToPartialSections(image, 1000, 3000);
  const auto whole_images = ToSections(image, 3000);
  ASSERT_EQ(images.size(), whole_images.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    EXPECT_EQ(images[i].utime, 1000);
    EXPECT_EQ(EncodeMessage(images[i].section), EncodeMessage(whole_images[i]));
  }
  const FeatureSet features = RandomValues(1).Features(1000, 64);
  const auto sets = ToPartialSections(features, 1000, 3000);
  const auto whole_sets = ToSections(features, 3000);
  ASSERT_EQ(sets.size(), whole_sets.size());
  for (std::size_t i = 0; i < sets.size(); ++i) {
    EXPECT_EQ(sets[i].utime, 1000);
    EXPECT_EQ(EncodeMessage(sets[i].section), EncodeMessage(whole_sets[i]));
  }
}

// Sets of one sweep would look alike, and late, if they had its utime.
TEST(PartialMessagesTest, FeaturesOfTwoLooksAreJoinedApart) {
  const auto now = std::chrono::steady_clock::time_point{};
  SectionJoiner<feature_set_t> joiner;
  int num_joined = 0;
  for (const std::int64_t known_until : {3000, 4000}) {
    for (const auto& partial :
         ToPartialSections(RandomValues(1).Features(1000, 64), 1000, known_until)) {
      if (joiner.Add(partial.section, now)) ++num_joined;
    }
  }
  EXPECT_EQ(num_joined, 2);
}

}  // namespace
}  // namespace rimod
