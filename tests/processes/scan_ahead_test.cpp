// Scans that are known when their sweep ends: told as they grow, and once more as a whole.

#include <gtest/gtest.h>

#include <csignal>
#include <memory>

#include "io/config.h"
#include "io/laser_messages.h"
#include "io/partial_messages.h"
#include "rimod/detector.h"
#include "rimod/growing_scan.h"
#include "tests/support/bus_probe.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tilting_laser.h"

namespace rimod {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLong(20000);
constexpr double kPeriod = 0.25;  // s

// The small room's sweep, cut off after so many lines, and the messages that tell it.
struct ToldSweep {
  explicit ToldSweep(std::size_t num_lines, std::int64_t begin = 1'000'000'000) {
    const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(begin), 60);
    SweepAssembler assembler(DefaultConfiguration(Method::kDefault).pipeline.sweep);
    const auto take = [&] {
      const std::optional<SweepGrowth> growth = assembler.TakeGrowth(kPeriod);
      if (growth) steps.push_back(ToPartialSections(*growth));
    };
    for (std::size_t i = 0; i <= num_lines; ++i) {
      assembler.AddPose(*FromMessage(laser.poses[i]).pose);
      take();
      if (i == num_lines) break;
      assembler.AddLine(*FromMessage(laser.lines[i]).line);
      take();
    }
    const Sweep sweep = assembler.Finish().at(0);
    EXPECT_TRUE(sweep.complete()) << sweep.incomplete_reason;
    if (sweep.rest->num_lines > 0) steps.push_back(ToPartialSections(*sweep.rest));
    end = ToScanEnd(sweep);
    scan = {sweep.begin.count(), sweep.end.count(), sweep.num_lines, sweep.num_missing_lines,
            sweep.scan};
  }
  std::vector<std::vector<partial_scan_t>> steps;
  scan_end_t end;
  StampedScan scan;
};

class ScanAheadTest : public ::testing::Test {
 protected:
  void Start(const std::string& executable, const std::string& config = "") {
    process_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{std::string(RIMOD_BIN_DIR) + "/" + executable, "--config",
                                 folder_.Write("ahead.yaml", "bus:\n  idle_time: 0.5\n" + config)},
        folder_.PathOf(executable));
    ASSERT_TRUE(bus_.ListenUntil([&] { return bus_.Status(executable).has_value(); }, kLong))
        << process_->Output();
  }
  void PublishSteps(const ToldSweep& told, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) bus_.PublishAll("RIMOD_SCAN_AHEAD", told.steps[i]);
  }
  // The features of these scans came, in this order, and nothing else.
  void ExpectDescribed(const std::vector<StampedScan>& scans) {
    const PipelineParams params = DefaultConfiguration(Method::kDefault).pipeline;
    std::vector<std::string> expected;
    for (const StampedScan& scan : scans) {
      const RangeImage image = ComputeRangeImage(scan.scan, params, Execution());
      const FeatureSet features = ExtractFeatures(image, params, Execution());
      for (const std::string& sum : SumsOf(ToSections(features, scan.utime)))
        expected.push_back(sum);
    }
    const auto sums = [&] { return SumsOf(bus_.Messages<feature_set_t>("RIMOD_FEATURES")); };
    bus_.ListenUntil([&] { return sums().size() >= expected.size(); }, kLong);
    EXPECT_EQ(sums(), expected) << process_->Output();
    EXPECT_TRUE(bus_.ListenUntil(
        [&] { return bus_.Status("rimod-extractor")->num_out == static_cast<int>(scans.size()); },
        kLong));
  }
  std::int64_t NumAhead() {
    return CounterOf(*bus_.Status("rimod-extractor"), "scans known ahead");
  }

  TemporaryFolder folder_;
  BusProbe bus_;
  std::unique_ptr<ChildProcess> process_;
};

TEST_F(ScanAheadTest, WhatTheAssemblerTellsAheadIsTheScan) {
  Start("rimod-assembler");
  const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(1'000'000'000), 60);
  for (std::size_t i = 0; i < laser.poses.size(); ++i) {
    bus_.Publish("LASER_TO_LOCAL", laser.poses[i]);
    if (i < laser.lines.size()) bus_.Publish("LASER", laser.lines[i]);
    bus_.Listen(milliseconds(1));
  }
  const ToldSweep told(60);
  const std::vector<std::string> scan = SumsOf(ToSections(told.scan));
  bus_.ListenUntil([&] { return bus_.Sums("RIMOD_SCAN", told.scan.utime).size() >= scan.size(); },
                   kLong);
  EXPECT_EQ(bus_.Sums("RIMOD_SCAN", told.scan.utime), scan);

  GrowingScan growing;
  for (const auto& message : bus_.Messages<partial_scan_t>("RIMOD_SCAN_AHEAD")) {
    ASSERT_EQ(message.section.num_sections, 1) << "the room is small";
    growing.Add(*SweepGrowthFrom(message.utime, message.step, {message.section}).growth);
  }
  const auto ends = bus_.Messages<scan_end_t>("RIMOD_SCAN_END");
  ASSERT_EQ(ends.size(), 1u);
  ASSERT_TRUE(growing.IsWhole(*FromMessage(ends[0]).end));
  EXPECT_GE(ends[0].num_steps, 4);
  EXPECT_EQ(growing.scan()->points, told.scan.scan.points);
  EXPECT_EQ(growing.scan()->no_return_directions, told.scan.scan.no_return_directions);
}

TEST_F(ScanAheadTest, ASweepThatIsTooSmallTellsNoEnd) {
  Start("rimod-assembler", "sweep:\n  min_sweep_angle_deg: 170\n");
  const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(1'000'000'000), 60);
  bus_.PublishAll("LASER_TO_LOCAL", laser.poses);
  bus_.PublishAll("LASER", laser.lines);
  EXPECT_TRUE(bus_.ListenUntil(
      [&] { return CounterOf(*bus_.Status("rimod-assembler"), "incomplete sweeps") == 1; }, kLong));
  EXPECT_FALSE(bus_.Bytes("RIMOD_SCAN_AHEAD").empty());
  EXPECT_TRUE(bus_.Bytes("RIMOD_SCAN_END").empty());
  EXPECT_TRUE(bus_.Bytes("RIMOD_SCAN").empty());
}

TEST_F(ScanAheadTest, TurnedOffItIsNotTold) {
  Start("rimod-assembler", "  scan_ahead: false\n");
  const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(1'000'000'000), 60);
  bus_.PublishAll("LASER_TO_LOCAL", laser.poses);
  bus_.PublishAll("LASER", laser.lines);
  EXPECT_TRUE(bus_.ListenUntil([&] { return !bus_.Bytes("RIMOD_SCAN").empty(); }, kLong));
  EXPECT_TRUE(bus_.Bytes("RIMOD_SCAN_AHEAD").empty());
  EXPECT_TRUE(bus_.Bytes("RIMOD_SCAN_END").empty());
}

TEST_F(ScanAheadTest, TheExtractorNeedsNoWholeScanAndWorksOnItOnce) {
  Start("rimod-extractor");
  const ToldSweep told(60);
  PublishSteps(told, 0, told.steps.size());
  bus_.Publish("RIMOD_SCAN_END", told.end);
  ExpectDescribed({told.scan});
  bus_.PublishAll("RIMOD_SCAN", ToSections(told.scan));
  bus_.Publish("RIMOD_SCAN_END", told.end);
  PublishSteps(told, told.steps.size() - 1, told.steps.size());
  bus_.Listen(milliseconds(1500));
  ExpectDescribed({told.scan});
  EXPECT_EQ(NumAhead(), 1);
  bus_.Listen(milliseconds(500));                        // sections are not late any more
  bus_.PublishAll("RIMOD_SCAN", ToSections(told.scan));  // a replay
  ExpectDescribed({told.scan, told.scan});
  EXPECT_EQ(bus_.Status("rimod-extractor")->num_dropped, 0);
}

TEST_F(ScanAheadTest, AMissingStepCostsTheScanNothing) {
  Start("rimod-extractor");
  const ToldSweep told(60);
  ASSERT_GE(told.steps.size(), 4u);
  PublishSteps(told, 0, 2);
  PublishSteps(told, 3, told.steps.size());
  bus_.Publish("RIMOD_SCAN_END", told.end);
  bus_.Listen(milliseconds(500));
  EXPECT_TRUE(bus_.Bytes("RIMOD_FEATURES").empty());
  bus_.PublishAll("RIMOD_SCAN", ToSections(told.scan));
  ExpectDescribed({told.scan});
  EXPECT_EQ(NumAhead(), 0);
}

TEST_F(ScanAheadTest, TheEndMayComeBeforeTheLastStep) {
  Start("rimod-extractor");
  const ToldSweep told(60);
  PublishSteps(told, 0, told.steps.size() - 1);
  bus_.Publish("RIMOD_SCAN_END", told.end);
  PublishSteps(told, told.steps.size() - 1, told.steps.size());
  ExpectDescribed({told.scan});
}

TEST_F(ScanAheadTest, ASweepThatGoesOnIsDescribedAgain) {
  Start("rimod-extractor");
  const ToldSweep half(45), whole(60);
  std::size_t common = 0;  // steps of both
  while (common < half.steps.size() && SumsOf(half.steps[common]) == SumsOf(whole.steps[common]))
    ++common;
  ASSERT_GE(common, 2u);
  scan_end_t early_end = half.end;
  const StampedScan early = [&] {
    GrowingScan growing;
    StampedScan scan;
    for (std::size_t i = 0; i < common; ++i) {
      const partial_scan_t& step = whole.steps[i].at(0);
      growing.Add(*SweepGrowthFrom(step.utime, step.step, {step.section}).growth);
      scan.num_lines += step.section.num_lines;
    }
    scan.utime = growing.sweep_begin().count();
    scan.utime_end = growing.end().count();
    scan.scan = *growing.scan();
    return scan;
  }();
  early_end.utime_end = early.utime_end;
  early_end.num_steps = static_cast<std::int32_t>(common);
  early_end.num_lines = early.num_lines;
  early_end.num_points = static_cast<std::int32_t>(early.scan.points.size());
  early_end.num_no_returns = static_cast<std::int32_t>(early.scan.no_return_directions.size());
  PublishSteps(whole, 0, common);
  bus_.Publish("RIMOD_SCAN_END", early_end);
  EXPECT_TRUE(bus_.ListenUntil([&] { return !bus_.Bytes("RIMOD_FEATURES").empty(); }, kLong));
  bus_.Listen(milliseconds(300));
  bus_.Forget();
  PublishSteps(whole, common, whole.steps.size());
  bus_.Publish("RIMOD_SCAN_END", whole.end);
  EXPECT_TRUE(bus_.ListenUntil([&] { return NumAhead() == 2; }, kLong));
}

TEST_F(ScanAheadTest, EndsThatDoNotFitGiveNothing) {
  Start("rimod-extractor");
  const ToldSweep told(60);
  PublishSteps(told, 0, told.steps.size());
  for (std::int32_t scan_end_t::*const count :
       {&scan_end_t::num_steps, &scan_end_t::num_lines, &scan_end_t::num_points,
        &scan_end_t::num_no_returns}) {
    for (const std::int32_t by : {-1, 1}) {
      scan_end_t bad = told.end;
      bad.*count += by;
      bus_.Publish("RIMOD_SCAN_END", bad);
    }
  }
  bus_.Listen(milliseconds(500));
  EXPECT_TRUE(bus_.Bytes("RIMOD_FEATURES").empty());
  bus_.Publish("RIMOD_SCAN_END", told.end);
  ExpectDescribed({told.scan});
}

}  // namespace
}  // namespace rimod
