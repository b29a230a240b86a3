// Faults while scans keep coming: processes killed in the middle of one, sections that are lost,
// repeated, late and mixed up. A fault costs at most the scans concerned, each loss is counted by
// its name, and whatever comes out is that of one scan, to the bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "tests/processes/faults_fixture.h"

namespace rimod {
namespace {

// Scans keep coming, as from a replay, while one process dies in the middle of one and returns.
TEST_F(FaultsTest, AProcessKilledInTheMiddleOfAScanCostsNoScanThatBeginsAfterItsRestart) {
  StartAndWait("rimod-extractor");
  StartAndWait("rimod-matcher");
  std::int64_t utime = 1;
  bus_.PublishAll("RIMOD_SCAN", ScanSections(utime));
  ASSERT_TRUE(WaitForDetections(utime));
  for (const std::string victim : {"rimod-extractor", "rimod-matcher"}) {
    const std::vector<scan_t> sections = ScanSections(++utime);
    bus_.PublishAll("RIMOD_SCAN", std::vector<scan_t>(sections.begin(), sections.begin() + 2));
    if (victim == "rimod-matcher") {  // between the sections of its own input
      bus_.PublishAll("RIMOD_SCAN", std::vector<scan_t>(sections.begin() + 2, sections.end()));
      ASSERT_TRUE(
          bus_.ListenUntil([&] { return !bus_.Sums("RIMOD_RANGE_IMAGE", utime).empty(); }, kLong));
    }
    processes_[victim]->Signal(SIGKILL);
    ASSERT_EQ(processes_[victim]->Wait(kLong), 128 + SIGKILL);
    if (victim == "rimod-extractor")
      bus_.PublishAll("RIMOD_SCAN", std::vector<scan_t>(sections.begin() + 2, sections.end()));
    Start(victim);
    const auto give_up = std::chrono::steady_clock::now() + kLong;
    while (!Speaks(victim) && std::chrono::steady_clock::now() < give_up)
      bus_.PublishAll("RIMOD_SCAN", ScanSections(++utime));  // is lost or not: nobody may mind
    const std::int64_t first_after = ++utime;
    bus_.PublishAll("RIMOD_SCAN", ScanSections(first_after));
    bus_.PublishAll("RIMOD_SCAN", ScanSections(++utime));
    EXPECT_TRUE(WaitForDetections(utime)) << processes_[victim]->Output();
    EXPECT_EQ(Detected().count(first_after), 1u) << "after a restart of " << victim;
  }
  ExpectAllRunning();
}

// Everything between extractor and matcher passes through here and meets a fault of its own.
TEST_F(FaultsTest, LostRepeatedLateAndInterleavedSectionsCostTheirScanOnly) {
  StartAndWait("rimod-matcher");
  const auto send_all = [&](std::int64_t utime) {
    bus_.PublishAll("RIMOD_RANGE_IMAGE", Stamped(Known(utime).image, utime));
    bus_.PublishAll("RIMOD_FEATURES", Stamped(Known(utime).features, utime));
  };
  const auto without = [](auto sections, std::size_t index) {
    sections.erase(sections.begin() + static_cast<std::ptrdiff_t>(index));
    return sections;
  };
  ASSERT_GT(Known(0).image.size(), 1u);
  // 1: every section of the image but one; 2: all of the image, no features.
  bus_.PublishAll("RIMOD_RANGE_IMAGE", without(Stamped(Known(1).image, 1), 1));
  bus_.PublishAll("RIMOD_FEATURES", Stamped(Known(1).features, 1));
  bus_.PublishAll("RIMOD_RANGE_IMAGE", Stamped(Known(2).image, 2));
  // 3 and 4, section by section in turn, the one forwards, the other backwards.
  const std::vector<range_image_t> forwards = Stamped(Known(3).image, 3);
  std::vector<range_image_t> backwards = Stamped(Known(4).image, 4);
  std::reverse(backwards.begin(), backwards.end());
  for (std::size_t i = 0; i < std::max(forwards.size(), backwards.size()); ++i) {
    if (i < forwards.size()) bus_.Publish("RIMOD_RANGE_IMAGE", forwards[i]);
    if (i < backwards.size()) bus_.Publish("RIMOD_RANGE_IMAGE", backwards[i]);
    bus_.Listen(milliseconds(2));
  }
  bus_.PublishAll("RIMOD_FEATURES", Stamped(Known(4).features, 4));
  bus_.PublishAll("RIMOD_FEATURES", Stamped(Known(3).features, 3));
  // 5: every section twice, and once more when the scan is done.
  for (const range_image_t& section : Stamped(Known(5).image, 5))
    bus_.PublishAll("RIMOD_RANGE_IMAGE", std::vector<range_image_t>{section, section});
  bus_.PublishAll("RIMOD_FEATURES", Stamped(Known(5).features, 5));
  bus_.PublishAll("RIMOD_RANGE_IMAGE", Stamped(Known(5).image, 5));
  // The section that 1 missed, long after it was given up.
  ASSERT_TRUE(bus_.ListenUntil(
      [&] { return Counter("rimod-matcher", "range image incomplete") == 1; }, kLong));
  bus_.Publish("RIMOD_RANGE_IMAGE", Stamped(Known(1).image, 1)[1]);
  send_all(6);
  EXPECT_TRUE(WaitForDetections(6));
  EXPECT_EQ(Detected(), (std::set<std::int64_t>{3, 4, 5, 6}));

  // 1 without image, 2 without features; the late section of 1 alone is no image either.
  EXPECT_TRUE(bus_.ListenUntil(
      [&] {
        return Counter("rimod-matcher", "scans without partner") == 2 &&
               Counter("rimod-matcher", "range image incomplete") == 2;
      },
      kLong));
  EXPECT_GE(Counter("rimod-matcher", "range image sections duplicated"),
            static_cast<std::int64_t>(Known(5).image.size()) - 1);
  EXPECT_GE(Counter("rimod-matcher", "range image sections late"), 1);
  EXPECT_EQ(bus_.Status("rimod-matcher")->num_dropped, 4);
  ExpectAllRunning();
}

// A packet filter that drops every so many-th packet of LCM in this private network; a message of
// ours is one packet here.
class Loss {
 public:
  static bool Possible() {
    return std::system("nft add table inet probe 2>/dev/null && nft delete table inet probe") == 0;
  }
  explicit Loss(int every) {
    const std::string rule =
        "nft 'table inet loss { chain in { type filter hook input priority 0; "
        "udp dport 7667 numgen inc mod " +
        std::to_string(every) + " 0 drop; }; }'";
    good_ = std::system(rule.c_str()) == 0;
  }
  ~Loss() { End(); }
  Loss(const Loss&) = delete;
  Loss& operator=(const Loss&) = delete;
  void End() {
    if (good_) good_ = std::system("nft delete table inet loss") != 0;
  }
  bool good() const { return good_; }

 private:
  bool good_ = false;
};

TEST_F(FaultsTest, OnALossyNetworkEveryScanIsDetectedOrCountedAsDropped) {
  if (!Loss::Possible()) GTEST_SKIP() << "no nft, or the kernel has no packet filter";
  StartAndWait("rimod-extractor");
  StartAndWait("rimod-matcher");
  constexpr std::int64_t kNumScans = 12;
  Loss loss(13);
  ASSERT_TRUE(loss.good());
  for (std::int64_t utime = 1; utime <= kNumScans; ++utime) {
    bus_.PublishAll("RIMOD_SCAN", ScanSections(utime));
    bus_.Listen(milliseconds(150));
  }
  loss.End();
  bus_.PublishAll("RIMOD_SCAN", ScanSections(kNumScans + 1));
  EXPECT_TRUE(WaitForDetections(kNumScans + 1)) << "the network is whole again";
  Detected();

  // A scan has more sections than one, so that some of each came.
  const auto accounted = [&] {
    const auto extractor = bus_.Status("rimod-extractor");
    return extractor &&
           extractor->num_out + CounterOf(*extractor, "scan incomplete") == kNumScans + 1;
  };
  EXPECT_TRUE(bus_.ListenUntil(accounted, kLong));
  bus_.Listen(milliseconds(1500));  // for the matcher's next status
  const status_t extractor = bus_.Status("rimod-extractor").value();
  const status_t matcher = bus_.Status("rimod-matcher").value();
  EXPECT_GT(extractor.num_dropped, 0) << "nothing was lost: nothing was tested";
  EXPECT_EQ(extractor.num_dropped, CounterOf(extractor, "scan incomplete"));
  EXPECT_LE(matcher.num_out, extractor.num_out);
  EXPECT_GE(matcher.num_out + matcher.num_dropped, extractor.num_out);
  EXPECT_EQ(matcher.num_dropped, CounterOf(matcher, "range image incomplete") +
                                     CounterOf(matcher, "features incomplete") +
                                     CounterOf(matcher, "scans without partner"));
  EXPECT_EQ(extractor.num_rejected + matcher.num_rejected, 0);
  ExpectAllRunning();
}

// This test hears what the assembler hears: its scan must be that of these lines and no others.
TEST_F(FaultsTest, TheAssemblersScanIsThatOfTheLinesThatArrived) {
  if (!Loss::Possible()) GTEST_SKIP() << "no nft, or the kernel has no packet filter";
  StartAndWait("rimod-assembler");
  const SweepParams params = DefaultConfiguration(Method::kDefault).pipeline.sweep;
  Loss loss(31);
  ASSERT_TRUE(loss.good());
  const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(1'000'000'000), 60);
  for (std::size_t i = 0; i < laser.poses.size(); ++i) {
    bus_.Publish("LASER_TO_LOCAL", laser.poses[i]);
    if (i < laser.lines.size()) bus_.Publish("LASER", laser.lines[i]);
    bus_.Listen(milliseconds(2));
  }
  loss.End();
  TiltingLaser heard;
  heard.lines = bus_.Messages<bot_core::planar_lidar_t>("LASER");
  heard.poses = bus_.Messages<bot_core::rigid_transform_t>("LASER_TO_LOCAL");
  ASSERT_LT(heard.lines.size() + heard.poses.size(), laser.lines.size() + laser.poses.size());
  const std::vector<Sweep> sweeps = Assemble(heard, params);
  ASSERT_EQ(sweeps.size(), 1u);
  ASSERT_TRUE(sweeps[0].complete()) << sweeps[0].incomplete_reason;
  EXPECT_GT(sweeps[0].num_missing_lines, 0);
  const std::vector<std::string> expected = SumsOf(
      ToSections(StampedScan{sweeps[0].begin.count(), sweeps[0].end.count(), sweeps[0].num_lines,
                             sweeps[0].num_missing_lines, sweeps[0].scan}));
  const std::int64_t utime = sweeps[0].begin.count();
  // What was sent last: an assembler may send what it has when lines stop, and again with the rest.
  const auto sent = [&] {
    std::vector<std::string> sums = bus_.Sums("RIMOD_SCAN", utime);
    const std::size_t num_earlier = sums.size() - std::min(sums.size(), expected.size());
    sums.erase(sums.begin(), sums.begin() + static_cast<std::ptrdiff_t>(num_earlier));
    return sums;
  };
  bus_.ListenUntil([&] { return sent() == expected; }, kLong);
  EXPECT_EQ(sent(), expected);
  EXPECT_TRUE(bus_.ListenUntil(
      [&] { return Counter("rimod-assembler", "missing lines") == sweeps[0].num_missing_lines; },
      kLong));
}

}  // namespace
}  // namespace rimod
