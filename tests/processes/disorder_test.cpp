// Disorder around the processes: clocks that step, stamps that repeat, two of what there should be
// one of, more scans than can be worked on. Noticed, counted by name, and over when its cause is.

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "io/status_counters.h"
#include "tests/processes/faults_fixture.h"

namespace rimod {
namespace {

class DisorderTest : public FaultsTest {
 protected:
  void PublishSweep(std::int64_t utime) {
    const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(utime), 60);
    for (std::size_t i = 0; i < laser.poses.size(); ++i) {
      bus_.Publish("LASER_TO_LOCAL", laser.poses[i]);
      if (i < laser.lines.size()) bus_.Publish("LASER", laser.lines[i]);
      bus_.Listen(milliseconds(2));
    }
  }
  bool WaitForCounter(const std::string& executable, const std::string& name, std::int64_t value) {
    return bus_.ListenUntil([&] { return Counter(executable, name) == value; }, kLong);
  }
  bool WaitForScan(std::int64_t utime) {
    return bus_.ListenUntil([&] { return !bus_.Sums("RIMOD_SCAN", utime).empty(); }, kLong);
  }
};

// Every process goes by the steady clock; what goes by the wall clock is the statuses' stamp.
TEST_F(DisorderTest, AWallClockThatStepsBackAndForthDisturbsNobody) {
  const std::string library = "/usr/lib/x86_64-linux-gnu/faketime/libfaketimeMT.so.1";
  if (!std::filesystem::exists(library)) GTEST_SKIP() << "no libfaketime";
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer's library must be the first that is loaded, libfaketime too";
#endif
  setenv("FAKETIME_TIMESTAMP_FILE", folder_.Write("step", "+0").c_str(), 1);
  setenv("FAKETIME_NO_CACHE", "1", 1);
  setenv("FAKETIME_DONT_FAKE_MONOTONIC", "1", 1);
  setenv("LD_PRELOAD", library.c_str(), 1);
  Start("rimod-extractor");
  Start("rimod-matcher");
  for (const char* name : {"LD_PRELOAD", "FAKETIME_TIMESTAMP_FILE", "FAKETIME_NO_CACHE",
                           "FAKETIME_DONT_FAKE_MONOTONIC"})
    unsetenv(name);
  for (const std::string name : {"rimod-extractor", "rimod-matcher"})
    ASSERT_TRUE(bus_.ListenUntil([&] { return Speaks(name); }, kLong));
  std::int64_t utime = 0;
  std::int64_t earliest = std::numeric_limits<std::int64_t>::max(), latest = 0;
  for (const std::string step : {"-3600", "+86400", "-100d", "+0"}) {
    folder_.Write("step", step);
    bus_.Forget();
    bus_.PublishAll("RIMOD_SCAN", ScanSections(++utime));
    EXPECT_TRUE(WaitForDetections(utime)) << "after a step of " << step;
    EXPECT_EQ(Detected(), std::set<std::int64_t>{utime});
    ASSERT_TRUE(bus_.ListenUntil([&] { return Speaks("rimod-matcher"); }, kLong))
        << "no status after a step of " << step;
    earliest = std::min(earliest, bus_.Status("rimod-matcher")->utime);
    latest = std::max(latest, bus_.Status("rimod-matcher")->utime);
  }
  constexpr std::int64_t kDay = 86'400'000'000;  // us
  EXPECT_GT(latest - earliest, 50 * kDay) << "the clock did not step: nothing was tested";
  ExpectAllRunning();
}

TEST_F(DisorderTest, AScannersClockThatStepsCostsTheSweepAtHandOnly) {
  StartAndWait("rimod-assembler");
  constexpr std::int64_t kHour = 3'600'000'000;  // us
  std::int64_t utime = 10 * kHour;
  PublishSweep(utime);
  EXPECT_TRUE(WaitForScan(utime));
  for (const std::int64_t step : {kHour, -3 * kHour, -std::int64_t{600'000}, 4 * kHour}) {
    // Half a sweep, then the step, then a whole one.
    const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(utime + 10'000'000), 60);
    for (std::size_t i = 0; i < 30; ++i) {
      bus_.Publish("LASER_TO_LOCAL", laser.poses[i]);
      bus_.Publish("LASER", laser.lines[i]);
    }
    utime += 10'000'000 + step;
    PublishSweep(utime);
    EXPECT_TRUE(WaitForScan(utime)) << "after a step of " << step << " us";
  }
  ExpectAllRunning();
}

TEST_F(DisorderTest, LinesOfOneUtimeAreCountedAndTheNextSweepIsWhole) {
  StartAndWait("rimod-assembler");
  TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(1'000'000'000), 60);
  for (std::size_t i = 0; i < laser.lines.size(); ++i) {
    laser.lines[i].utime = laser.poses[i].utime = 1'000'000'000;
    bus_.Publish("LASER_TO_LOCAL", laser.poses[i]);
    bus_.Publish("LASER", laser.lines[i]);
    bus_.Listen(milliseconds(1));
  }
  EXPECT_TRUE(WaitForCounter("rimod-assembler", "unordered lines", 59));
  PublishSweep(2'000'000'000);
  EXPECT_TRUE(WaitForScan(2'000'000'000));
}

// Two different scans that say they are the same one: given up, not mixed.
TEST_F(DisorderTest, ScansOfOneUtimeAreNotMixed) {
  StartAndWait("rimod-extractor");
  StartAndWait("rimod-matcher");
  std::vector<scan_t> other = Stamped(Known(2).sections, 1);
  const std::vector<scan_t> first = ScanSections(1);
  for (scan_t& section : other) section.utime_end = 1;
  for (std::size_t i = 0; i < std::max(first.size(), other.size()); ++i) {
    if (i < first.size()) bus_.Publish("RIMOD_SCAN", first[i]);
    if (i < other.size()) bus_.Publish("RIMOD_SCAN", other[i]);
    bus_.Listen(milliseconds(2));
  }
  bus_.PublishAll("RIMOD_SCAN", ScanSections(6));
  EXPECT_TRUE(WaitForDetections(6));
  EXPECT_EQ(Detected().count(6), 1u);  // and whatever else came is that of scan 1, to the bit
  ExpectAllRunning();
}

// Two sweeps of one utime, of which the first's image got lost: its features are of no other image.
TEST_F(DisorderTest, AnImageAndFeaturesOfTwoScansWithOneUtimeAreNotPaired) {
  StartAndWait("rimod-matcher");
  const auto image = [&](std::int64_t scan) {
    bus_.PublishAll("RIMOD_RANGE_IMAGE", Stamped(Known(scan).image, 5));
  };
  const auto features = [&](std::int64_t scan) {
    bus_.PublishAll("RIMOD_FEATURES", Stamped(Known(scan).features, 5));
  };
  features(2);
  image(1);  // Known(1) is what Known(5) is
  EXPECT_TRUE(bus_.ListenUntil(
      [&] { return Counter("rimod-matcher", "pairs of two scans refused") == 1; }, kLong));
  EXPECT_TRUE(bus_.Bytes("RIMOD_DETECTIONS").empty());
  EXPECT_NE(bus_.Status("rimod-matcher")->last_error.find("scan 5"), std::string::npos);
  EXPECT_TRUE(bus_.ListenUntil(
      [&] { return Counter("rimod-matcher", "scans without partner") == 2; }, kLong));
  bus_.Listen(milliseconds(600));
  image(1);
  image(2);
  bus_.Listen(milliseconds(10));
  features(1);
  EXPECT_TRUE(WaitForDetections(5));
  EXPECT_EQ(Detected().count(5), 1u);  // to the bit
  ExpectAllRunning();
}

TEST_F(DisorderTest, TwoExtractorsNoticeEachOtherAndTheDetectionsStayRight) {
  StartAndWait("rimod-extractor");
  StartAndWait("rimod-matcher");
  EXPECT_EQ(Counter("rimod-extractor", std::string(kSendsPrefix) + "RIMOD_FEATURES"), 1);
  EXPECT_EQ(bus_.Status("rimod-extractor")->last_error, "");
  {
    ChildProcess second({std::string(RIMOD_BIN_DIR) + "/rimod-extractor"},
                        folder_.PathOf("second"));
    std::set<pid_t> noticed;
    EXPECT_TRUE(bus_.ListenUntil(
        [&] {
          for (const status_t& status : bus_.Messages<status_t>("RIMOD_STATUS"))
            if (CounterOf(status, "other senders on RIMOD_FEATURES") == 1 &&
                status.last_error.find("too many") != std::string::npos)
              noticed.insert(status.pid);
          return noticed == std::set<pid_t>{second.pid(), processes_["rimod-extractor"]->pid()};
        },
        kLong))
        << second.Output();
    bus_.PublishAll("RIMOD_SCAN", ScanSections(1));
    EXPECT_TRUE(WaitForDetections(1));
    bus_.Listen(milliseconds(1500));
    EXPECT_EQ(Detected().count(1), 1u);
  }
  EXPECT_TRUE(bus_.ListenUntil(
      [&] { return Counter("rimod-extractor", "other senders on RIMOD_FEATURES") == 0; }, kLong))
      << "the second one has ended";
  bus_.PublishAll("RIMOD_SCAN", ScanSections(2));
  EXPECT_TRUE(WaitForDetections(2));
  ExpectAllRunning();
}

TEST_F(DisorderTest, TwoScannersOnOneChannelGiveNoMixedScanAndAreTold) {
  StartAndWait("rimod-assembler");
  const TiltingLaser one = TiltInFrontOf(SmallRoom(), Time(1'000'000'000), 60);
  const TiltingLaser two = TiltInFrontOf(SmallRoom(), Time(1'000'009'000), 60);
  for (std::size_t i = 0; i < one.poses.size(); ++i) {
    bus_.Publish("LASER_TO_LOCAL", one.poses[i]);
    if (i < one.lines.size()) {
      bus_.Publish("LASER", one.lines[i]);
      bus_.Publish("LASER", two.lines[i]);
    }
    bus_.Listen(milliseconds(2));
  }
  EXPECT_TRUE(
      bus_.ListenUntil([&] { return Counter("rimod-assembler", "incomplete sweeps") > 0; }, kLong));
  EXPECT_GT(Counter("rimod-assembler", "lines too soon"), 50);
  EXPECT_NE(bus_.Status("rimod-assembler")->last_error.find("two on one channel"),
            std::string::npos)
      << bus_.Status("rimod-assembler")->last_error;
  EXPECT_TRUE(bus_.Bytes("RIMOD_SCAN").empty());
  PublishSweep(2'000'000'000);
  EXPECT_TRUE(WaitForScan(2'000'000'000)) << "one of them is gone";
}

TEST_F(DisorderTest, AMatcherWithoutModelsTellsOfEveryScanThatItFoundNothing) {
  const std::string empty = folder_.PathOf("no_models");
  std::filesystem::create_directory(empty);
  processes_["rimod-matcher"] = std::make_unique<ChildProcess>(
      std::vector<std::string>{std::string(RIMOD_BIN_DIR) + "/rimod-matcher", "--models", empty},
      folder_.PathOf("rimod-matcher"));
  ASSERT_TRUE(bus_.ListenUntil([&] { return Speaks("rimod-matcher"); }, kLong));
  bus_.PublishAll("RIMOD_RANGE_IMAGE", Stamped(Known(1).image, 1));
  bus_.PublishAll("RIMOD_FEATURES", Stamped(Known(1).features, 1));
  ASSERT_TRUE(WaitForDetections(1));
  const detections_t message = bus_.Messages<detections_t>("RIMOD_DETECTIONS").back();
  EXPECT_EQ(message.num_models, 0);
  EXPECT_EQ(message.num_detections, 0);
  EXPECT_TRUE(WaitForCounter("rimod-matcher", "models", 0));
  ExpectAllRunning();
}

// Under a bound that a queue without end would break soon.
TEST_F(DisorderTest, UnderOverloadMemoryIsFlatAndTheNewestScansAreDone) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer reserves more memory than ulimit -v leaves";
#endif
  const auto start = [&](const std::string& executable) {
    std::string command =
        "ulimit -v 1500000; exec " + std::string(RIMOD_BIN_DIR) + "/" + executable + " --threads 1";
    if (executable == "rimod-matcher") command += " --models " + models_->path();
    processes_[executable] = std::make_unique<ChildProcess>(
        std::vector<std::string>{"sh", "-c", command}, folder_.PathOf(executable));
    ASSERT_TRUE(bus_.ListenUntil([&] { return Speaks(executable); }, kLong))
        << processes_[executable]->Output();
  };
  start("rimod-extractor");
  start("rimod-matcher");
  std::int64_t utime = 0;
  std::map<std::string, std::int64_t> early;
  constexpr std::int64_t kNumScans = 150;
  for (; utime < kNumScans; ++utime) {
    for (const scan_t& section : ScanSections(utime + 1)) bus_.Publish("RIMOD_SCAN", section);
    bus_.Listen(milliseconds(15));
    if (utime == kNumScans / 3)
      for (const auto& [name, process] : processes_) early[name] = Counter(name, kMemoryCounter);
  }
  bus_.Listen(milliseconds(1500));
  EXPECT_GT(Counter("rimod-extractor", "scans overtaken"), 5) << "there was no overload";
  for (const auto& [name, process] : processes_) {
    ASSERT_GT(early[name], 0);
    EXPECT_LT(Counter(name, kMemoryCounter), 2 * early[name] + 30'000) << name;
    EXPECT_LE(Counter(name, kWaitingScansCounter), 1) << name;
  }
  bus_.PublishAll("RIMOD_SCAN", ScanSections(++utime));
  EXPECT_TRUE(WaitForDetections(utime));
  Detected();
  ExpectAllRunning();
}

}  // namespace
}  // namespace rimod
