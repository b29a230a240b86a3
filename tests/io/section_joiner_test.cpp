#include "io/section_joiner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "io/feature_messages.h"
#include "io/range_image_messages.h"
#include "io/scan_messages.h"
#include "rimod/object_model_t.hpp"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

using std::chrono::milliseconds;

// A scan of that many sections, each with one point that tells scan and section.
std::vector<scan_t> SmallScan(std::int64_t utime, int num_sections, float mark = 0.0f) {
  std::vector<scan_t> sections;
  for (int i = 0; i < num_sections; ++i) {
    scan_t section = {};
    section.utime = utime;
    section.section = i;
    section.num_sections = num_sections;
    section.sensor_orientation[0] = 1.0;
    section.num_points = 1;
    section.x = {static_cast<float>(utime)};
    section.y = {static_cast<float>(i)};
    section.z = {mark};
    sections.push_back(section);
  }
  return sections;
}

class SectionJoinerTest : public ::testing::Test {
 protected:
  // Adds at the time that has been reached; counts and checks what comes out whole.
  bool Add(const scan_t& section) {
    const std::optional<std::vector<scan_t>> whole = joiner_.Add(section, now_);
    if (!whole) return false;
    EXPECT_EQ(whole->size(), static_cast<std::size_t>(section.num_sections));
    for (std::size_t i = 0; i < whole->size(); ++i) {
      EXPECT_EQ((*whole)[i].section, static_cast<std::int32_t>(i));
      EXPECT_EQ((*whole)[i].y[0], static_cast<float>(i));
      EXPECT_EQ((*whole)[i].x[0], static_cast<float>(section.utime));
      EXPECT_EQ((*whole)[i].z[0], whole->front().z[0]) << "two scans are mixed";
    }
    return true;
  }
  int AddAll(const std::vector<scan_t>& sections) {
    int num_wholes = 0;
    for (const scan_t& section : sections) num_wholes += Add(section) ? 1 : 0;
    return num_wholes;
  }

  SectionJoiner<scan_t> joiner_;
  SectionJoiner<scan_t>::Time now_{};
};

TEST_F(SectionJoinerTest, TheLastSectionCompletesTheWhole) {
  const std::vector<scan_t> sections = SmallScan(1, 3);
  EXPECT_FALSE(Add(sections[0]));
  EXPECT_FALSE(Add(sections[1]));
  EXPECT_TRUE(Add(sections[2]));
  EXPECT_EQ(joiner_.counters().completed, 1);
  EXPECT_EQ(joiner_.num_open(), 0u);
}

TEST_F(SectionJoinerTest, AWholeOfOneSectionIsCompleteAtOnce) {
  EXPECT_EQ(AddAll(SmallScan(1, 1)), 1);
}

TEST_F(SectionJoinerTest, AnyOrderOfSectionsWillDo) {
  std::vector<scan_t> sections = SmallScan(1, 4);
  std::vector<int> order = {0, 1, 2, 3};
  std::int64_t utime = 1;
  do {
    std::vector<scan_t> shuffled;
    for (const int i : order) shuffled.push_back(SmallScan(utime, 4)[static_cast<std::size_t>(i)]);
    EXPECT_EQ(AddAll(shuffled), 1);
    ++utime;
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_F(SectionJoinerTest, InterleavedScansAreKeptApart) {
  const std::vector<scan_t> a = SmallScan(1, 3);
  const std::vector<scan_t> b = SmallScan(2, 3);
  EXPECT_EQ(AddAll({a[0], b[0], b[1], a[1], b[2], a[2]}), 2);
  EXPECT_EQ(joiner_.counters().incomplete, 0);
}

TEST_F(SectionJoinerTest, ADuplicatedSectionCountsOnce) {
  const std::vector<scan_t> a = SmallScan(1, 3);
  EXPECT_EQ(AddAll({a[0], a[0], a[1], a[1], a[0], a[2]}), 1);
  EXPECT_EQ(joiner_.counters().duplicated, 3);
}

TEST_F(SectionJoinerTest, WhatComesAfterTheWholeIsLate) {
  const std::vector<scan_t> a = SmallScan(1, 3);
  EXPECT_EQ(AddAll(a), 1);
  EXPECT_EQ(AddAll(a), 0);
  EXPECT_EQ(joiner_.counters().late, 3);
  EXPECT_EQ(joiner_.num_open(), 0u);
}

TEST_F(SectionJoinerTest, ALogThatIsReplayedLaterIsJoinedAgain) {
  EXPECT_EQ(AddAll(SmallScan(1, 3)), 1);
  now_ += milliseconds(600);
  EXPECT_EQ(AddAll(SmallScan(1, 3)), 1);
}

// A sensor whose clock stands still, ten scans a second: nothing tells to which scan a section
// belongs.
TEST_F(SectionJoinerTest, OfScansWithOneNameThatFollowEachOtherOnlyTheFirstIsJoined) {
  int num_wholes = 0;
  for (int scan = 0; scan < 100; ++scan) {
    for (const scan_t& section : SmallScan(1, 7, static_cast<float>(scan))) {
      num_wholes += Add(section);
      now_ += milliseconds(3);
    }
    now_ += milliseconds(79);
  }
  EXPECT_EQ(num_wholes, 1);
  EXPECT_EQ(joiner_.counters().same_name, 99);
  EXPECT_EQ(joiner_.counters().late, 99 * 7);
  EXPECT_EQ(AddAll(SmallScan(2, 7)), 1) << "another name is another matter";
  now_ += milliseconds(501);
  EXPECT_EQ(AddAll(SmallScan(1, 7, 5.0f)), 1) << "after a pause the next is told apart by time";
}

// Slower ones are told apart by the pauses between them.
TEST_F(SectionJoinerTest, OfSlowScansWithOneNameALostSectionCostsTheOneThatItIsOf) {
  RandomValues random(7);
  int num_wholes = 0, num_sent_whole = 0;
  for (int scan = 0; scan < 3000; ++scan) {
    const std::vector<scan_t> sections = SmallScan(1, 7, static_cast<float>(scan));
    const unsigned lost = random.Int(0, 1) == 0 ? 0u : 1u << random.Int(0, 6);
    num_sent_whole += lost == 0;
    for (unsigned i = 0; i < 7; ++i) {
      if (!(lost >> i & 1u)) num_wholes += Add(sections[i]);  // fails where two are mixed
      now_ += milliseconds(3);
    }
    now_ += milliseconds(random.Int(510, 1500));
  }
  EXPECT_EQ(num_wholes, num_sent_whole);
  EXPECT_EQ(joiner_.counters().incomplete + static_cast<int>(joiner_.num_open()),
            3000 - num_sent_whole);
}

TEST_F(SectionJoinerTest, OfFastScansWithOneNameNoneIsMixedUnderLoss) {
  RandomValues random(8);
  for (int round = 0; round < 200; ++round) {
    AddAll(SmallScan(round, 7, 0.0f));
    const int period = random.Int(22, 450);  // ms, shorter than the memory
    for (int scan = 1; scan < 12; ++scan) {
      now_ += milliseconds(period - 21);
      for (const scan_t& section : SmallScan(round, 7, static_cast<float>(scan))) {
        if (random.Int(0, 4) != 0) Add(section);  // fails where two are mixed
        now_ += milliseconds(3);
      }
    }
  }
  EXPECT_GT(joiner_.counters().same_name, 1000);
}

TEST_F(SectionJoinerTest, AMissingSectionCostsThatScanOnly) {
  const std::vector<scan_t> a = SmallScan(1, 3);
  EXPECT_EQ(AddAll({a[0], a[2]}), 0);
  EXPECT_EQ(AddAll(SmallScan(2, 3)), 1);
  now_ += milliseconds(5001);
  EXPECT_EQ(AddAll(SmallScan(3, 3)), 1);
  EXPECT_EQ(joiner_.counters().incomplete, 1);
  EXPECT_EQ(joiner_.num_open(), 0u);
}

TEST_F(SectionJoinerTest, StaleWholesAreGivenUpWithoutNewSections) {
  Add(SmallScan(1, 3)[0]);
  joiner_.GiveUpStale(now_ + milliseconds(4000));
  EXPECT_EQ(joiner_.num_open(), 1u);
  joiner_.GiveUpStale(now_ + milliseconds(6000));
  EXPECT_EQ(joiner_.num_open(), 0u);
  EXPECT_EQ(joiner_.counters().incomplete, 1);
}

TEST_F(SectionJoinerTest, WrongSectionNumbersAreLeftOut) {
  scan_t section = SmallScan(1, 3)[0];
  for (const auto& [number, total] :
       {std::pair(-1, 3), std::pair(3, 3), std::pair(0, 0), std::pair(0, -1),
        std::pair(5, 2000000000), std::pair(2000000000, 3), std::pair(0, 4097)}) {
    section.section = number;
    section.num_sections = total;
    EXPECT_FALSE(Add(section));
  }
  EXPECT_EQ(joiner_.counters().bad_numbers, 7);
  EXPECT_EQ(joiner_.num_open(), 0u);
  EXPECT_EQ(AddAll(SmallScan(1, 3)), 1);
}

TEST_F(SectionJoinerTest, TwoSendersOfOneTimeWithDifferentHeadersAreKeptApart) {
  const std::vector<scan_t> a = SmallScan(1, 3, 1.0f);
  const std::vector<scan_t> b = SmallScan(1, 4, 2.0f);
  std::vector<scan_t> c = SmallScan(1, 3, 3.0f);
  for (scan_t& section : c) section.sensor_position[0] = 1e-9;
  EXPECT_EQ(AddAll({a[0], b[0], c[0], c[1], b[1], a[1], b[2], c[2], a[2], b[3]}), 3);
}

TEST_F(SectionJoinerTest, TwoSendersOfOneTimeThatDisagreeAreGivenUp) {
  const std::vector<scan_t> a = SmallScan(1, 3, 1.0f);
  const std::vector<scan_t> b = SmallScan(1, 3, 2.0f);
  EXPECT_EQ(AddAll({a[0], b[0], a[1], b[1], a[2], b[2]}), 0);
  EXPECT_EQ(joiner_.counters().conflicting, 1);
  EXPECT_EQ(joiner_.counters().late, 4);
  EXPECT_EQ(AddAll(SmallScan(2, 3)), 1);
}

TEST_F(SectionJoinerTest, NoMoreThanTheAllowedWholesAreUnderWay) {
  for (std::int64_t utime = 0; utime < 1000; ++utime) {
    now_ += milliseconds(1);
    Add(SmallScan(utime, 5)[0]);
    EXPECT_LE(joiner_.num_open(), 4u);
  }
  EXPECT_EQ(joiner_.counters().incomplete, 996);
}

TEST_F(SectionJoinerTest, TheLongestUntouchedWholeIsGivenUpFirst) {
  std::vector<std::vector<scan_t>> scans;
  for (std::int64_t utime = 0; utime < 5; ++utime) scans.push_back(SmallScan(utime, 2));
  for (std::size_t i = 0; i < 4; ++i) {
    Add(scans[i][0]);
    now_ += milliseconds(1);
  }
  Add(scans[4][0]);  // scan 0 goes
  EXPECT_TRUE(Add(scans[1][1]));
  EXPECT_TRUE(Add(scans[4][1]));
  EXPECT_FALSE(Add(scans[0][1]));
}

TEST(SectionJoinerMemoryTest, NoMoreThanTheAllowedBytesAreKept) {
  SectionJoinerParams params;
  params.max_bytes = 300000;
  SectionJoiner<scan_t> joiner(params);
  StampedScan scan;
  scan.scan = RandomValues(1).AScan(50000, 0);  // about 600 kB
  int num_wholes = 0;
  for (const scan_t& section : ToSections(scan)) num_wholes += joiner.Add(section, {}) ? 1 : 0;
  EXPECT_EQ(num_wholes, 0);
  EXPECT_EQ(joiner.counters().incomplete, 1);
  EXPECT_GT(joiner.counters().late, 0);
}

// A hundred scans whose sections are lost, doubled and shuffled within a window, with a fixed seed:
// what comes out is whole, unmixed and exactly those scans that lost nothing.
TEST_F(SectionJoinerTest, UnderLossAndDisorderExactlyTheCompleteScansComeOut) {
  RandomValues random(8);
  int num_complete = 0;
  int num_wholes = 0;
  std::vector<scan_t> window;
  for (std::int64_t utime = 0; utime < 100; ++utime) {
    bool complete = true;
    for (const scan_t& section : SmallScan(utime, random.Int(1, 6))) {
      const int fate = random.Int(0, 19);
      if (fate == 0) complete = false;
      const int copies = fate == 0 ? 0 : fate == 1 ? 2 : 1;
      for (int i = 0; i < copies; ++i) window.push_back(section);
    }
    num_complete += complete ? 1 : 0;
    // Between one scan and the next the sections are shuffled.
    for (std::size_t i = window.size(); i-- > 1;) {
      std::swap(window[i], window[static_cast<std::size_t>(random.Int(0, static_cast<int>(i)))]);
    }
    num_wholes += AddAll(window);
    window.clear();
    now_ += milliseconds(100);
  }
  EXPECT_EQ(num_wholes, num_complete);
  EXPECT_GT(num_complete, 50);
  EXPECT_LT(num_complete, 100);
}

template <typename Section>
void ExpectJoinsReversed(std::vector<Section> sections) {
  ASSERT_GE(sections.size(), 2u);
  std::reverse(sections.begin(), sections.end());
  SectionJoiner<Section> joiner;
  int num_wholes = 0;
  for (const Section& section : sections) {
    const auto whole = joiner.Add(section, {});
    if (!whole) continue;
    ++num_wholes;
    for (std::size_t i = 0; i < whole->size(); ++i) {
      EXPECT_EQ((*whole)[i].section, static_cast<std::int32_t>(i));
    }
  }
  EXPECT_EQ(num_wholes, 1);
}

TEST(SectionJoinerTypesTest, AllTypesOfSectionsAreJoined) {
  RandomValues random(9);
  ExpectJoinsReversed(ToSections(random.AnImage(400, 100), 1));
  ExpectJoinsReversed(ToSections(random.Features(1000, 64), 1));
  std::vector<object_model_t> model(2);
  for (int i = 0; i < 2; ++i) {
    object_model_t section = {};
    section.section = i;
    section.num_sections = 2;
    section.name = "fan";
    model[static_cast<std::size_t>(i)] = section;
  }
  ExpectJoinsReversed(model);
}

}  // namespace
}  // namespace rimod
