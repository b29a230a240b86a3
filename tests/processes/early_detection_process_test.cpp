// Growing scans through the real processes: what each makes of them, and that whole scans go first.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <memory>

#include "io/cloud_messages.h"
#include "io/config.h"
#include "io/detection_messages.h"
#include "io/early_messages.h"
#include "io/laser_messages.h"
#include "io/model_messages.h"
#include "io/partial_messages.h"
#include "rimod/detector.h"
#include "rimod/growing_scan.h"
#include "tests/support/bus_probe.h"
#include "tests/support/child_process.h"
#include "tests/support/surfel_models.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tilting_laser.h"

namespace rimod {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLong(20000);
constexpr std::int64_t kBegin = 1'000'000'000;
constexpr double kPeriod = 0.3;  // s

// The small room's sweep, and what it grows by.
struct GrowingRoom {
  GrowingRoom() : params(DefaultConfiguration(Method::kDefault).pipeline) {
    SweepAssembler assembler(params.sweep);
    const auto take = [&] {
      const std::optional<SweepGrowth> growth = assembler.TakeGrowth(kPeriod);
      if (growth) growths.push_back(*growth);
    };
    for (std::size_t i = 0; i < laser.poses.size(); ++i) {
      assembler.AddPose(*FromMessage(laser.poses[i]).pose);
      take();
      if (i == laser.lines.size()) break;
      assembler.AddLine(*FromMessage(laser.lines[i]).line);
      take();
    }
    const std::vector<Sweep> sweeps = Assemble(laser, params.sweep);
    scan = {sweeps.at(0).begin.count(), sweeps[0].end.count(), sweeps[0].num_lines,
            sweeps[0].num_missing_lines, sweeps[0].scan};
  }

  // Image and features of what is known after so many growths.
  std::pair<RangeImage, FeatureSet> LookAfter(std::size_t num_growths) const {
    GrowingScan growing;
    for (std::size_t i = 0; i < num_growths; ++i) growing.Add(growths.at(i));
    const RangeImage image = ComputeRangeImage(*growing.scan(), params, Execution());
    return {image, ExtractFeatures(image, params, Execution())};
  }

  PipelineParams params;
  TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(kBegin), 60);
  std::vector<SweepGrowth> growths;
  StampedScan scan;
};

class EarlyProcessTest : public ::testing::Test {
 protected:
  // To the matcher; waits until it looks for it.
  void GiveModel() {
    bus_.PublishAll("RIMOD_MODEL", ToSections(BoxModel("box", {0.6, 0.5, 0.7}, 0.03), 2));
    ASSERT_TRUE(bus_.ListenUntil(
        [&] {
          const auto status = bus_.Status("rimod-matcher");
          return status && CounterOf(*status, "models") == 1;
        },
        kLong));
  }

  std::unique_ptr<ChildProcess> Start(const std::string& executable,
                                      std::vector<std::string> arguments = {}) {
    const std::string config = folder_.Write(
        "early.yaml", "bus:\n  idle_time: 0.3\n  join_patience: 0.5\nearly:\n  period: " +
                          std::to_string(kPeriod) + "\n");
    arguments.insert(arguments.begin(),
                     {std::string(RIMOD_BIN_DIR) + "/" + executable, "--config", config});
    auto process = std::make_unique<ChildProcess>(arguments, folder_.PathOf(executable));
    EXPECT_TRUE(bus_.ListenUntil([&] { return bus_.Status(executable).has_value(); }, kLong))
        << process->Output();
    return process;
  }
  void PublishSweep(std::size_t num_lines) {
    for (std::size_t i = 0; i < num_lines; ++i) {
      bus_.Publish("LASER_TO_LOCAL", room_.laser.poses[i]);
      bus_.Publish("LASER", room_.laser.lines[i]);
      bus_.Listen(milliseconds(1));
    }
    bus_.Publish("LASER_TO_LOCAL", room_.laser.poses[num_lines]);
  }
  void PublishLook(std::size_t num_growths, std::int64_t known_until) {
    const auto [image, features] = room_.LookAfter(num_growths);
    bus_.PublishAll("RIMOD_RANGE_IMAGE_PARTIAL",
                    ToPartialSections(image, room_.scan.utime, known_until));
    bus_.PublishAll("RIMOD_FEATURES_PARTIAL",
                    ToPartialSections(features, room_.scan.utime, known_until));
  }
  std::vector<early_detections_t> Told() {
    return bus_.Messages<early_detections_t>("RIMOD_DETECTIONS_EARLY");
  }
  bool WaitForTold(const std::function<bool(const early_detections_t&)>& wanted) {
    return bus_.ListenUntil(
        [&] {
          const auto told = Told();
          return std::any_of(told.begin(), told.end(), wanted);
        },
        kLong);
  }

  TemporaryFolder folder_;
  BusProbe bus_;
  GrowingRoom room_;
};

TEST_F(EarlyProcessTest, TheAssemblerTellsGrowthOnlyWhenAskedAndTheScanStaysTheSame) {
  ASSERT_GE(room_.growths.size(), 3u);
  const std::vector<std::string> scan = SumsOf(ToSections(room_.scan));
  for (const bool early : {false, true}) {
    const auto assembler = Start("rimod-assembler", early ? std::vector<std::string>{"--early"}
                                                          : std::vector<std::string>{});
    PublishSweep(room_.laser.lines.size());
    bus_.ListenUntil(
        [&] { return bus_.Sums("RIMOD_SCAN", room_.scan.utime).size() >= scan.size(); }, kLong);
    EXPECT_EQ(bus_.Sums("RIMOD_SCAN", room_.scan.utime), scan);
    std::vector<std::string> growths;
    for (const SweepGrowth& growth : room_.growths) {
      for (const std::string& sum : SumsOf(ToPartialSections(growth))) growths.push_back(sum);
    }
    if (!early) growths.clear();
    EXPECT_EQ(bus_.Sums("RIMOD_SCAN_PARTIAL", room_.scan.utime), growths);
    assembler->Signal(SIGTERM);
    EXPECT_EQ(assembler->Wait(milliseconds(2000)), 0);
    bus_.Forget();
  }
}

TEST_F(EarlyProcessTest, TheExtractorDescribesWhatIsKnownSoFar) {
  const auto extractor = Start("rimod-extractor");
  for (std::size_t i = 0; i < 2; ++i) {
    const auto [image, features] = room_.LookAfter(i + 1);
    const std::int64_t known_until = room_.growths[i].end.count();
    bus_.Forget();
    bus_.PublishAll("RIMOD_SCAN_PARTIAL", ToPartialSections(room_.growths[i]));
    const auto images = SumsOf(ToPartialSections(image, room_.scan.utime, known_until));
    const auto sets = SumsOf(ToPartialSections(features, room_.scan.utime, known_until));
    bus_.ListenUntil(
        [&] { return bus_.Sums("RIMOD_FEATURES_PARTIAL", room_.scan.utime).size() >= sets.size(); },
        kLong);
    EXPECT_EQ(bus_.Sums("RIMOD_FEATURES_PARTIAL", room_.scan.utime), sets);
    EXPECT_EQ(bus_.Sums("RIMOD_RANGE_IMAGE_PARTIAL", room_.scan.utime), images);
  }
  EXPECT_TRUE(bus_.Bytes("RIMOD_RANGE_IMAGE").empty());
}

TEST_F(EarlyProcessTest, AfterTheScanItsGrowthIsLate) {
  const auto extractor = Start("rimod-extractor");
  bus_.PublishAll("RIMOD_SCAN", ToSections(room_.scan));
  bus_.PublishAll("RIMOD_SCAN_PARTIAL", ToPartialSections(room_.growths[0]));
  EXPECT_TRUE(bus_.ListenUntil(
      [&] { return CounterOf(*bus_.Status("rimod-extractor"), "partial scans overtaken") == 1; },
      kLong));
  EXPECT_TRUE(bus_.ListenUntil([&] { return !bus_.Bytes("RIMOD_FEATURES").empty(); }, kLong));
  EXPECT_TRUE(bus_.Bytes("RIMOD_FEATURES_PARTIAL").empty());
}

TEST_F(EarlyProcessTest, ALostStepCostsNothingButTheLooksAtThatSweep) {
  const auto extractor = Start("rimod-extractor");
  bus_.PublishAll("RIMOD_SCAN_PARTIAL", ToPartialSections(room_.growths[1]));
  bus_.PublishAll("RIMOD_SCAN_PARTIAL", ToPartialSections(room_.growths[2]));
  bus_.PublishAll("RIMOD_SCAN", ToSections(room_.scan));
  EXPECT_TRUE(bus_.ListenUntil([&] { return !bus_.Bytes("RIMOD_FEATURES").empty(); }, kLong));
  EXPECT_TRUE(bus_.Bytes("RIMOD_FEATURES_PARTIAL").empty());
  EXPECT_EQ(bus_.Status("rimod-extractor")->num_rejected, 0);
}

TEST_F(EarlyProcessTest, TheMatcherTellsEachLookAndTheEnd) {
  const auto matcher = Start("rimod-matcher");
  GiveModel();
  const std::int64_t known_until = room_.growths[1].end.count();
  PublishLook(2, known_until);
  ASSERT_TRUE(WaitForTold([&](const early_detections_t& told) {
    return told.utime == room_.scan.utime && told.utime_end == known_until && !told.is_final &&
           told.num_models == 1;
  })) << matcher->Output();
  EXPECT_TRUE(bus_.Bytes("RIMOD_DETECTIONS").empty());

  const RangeImage image = ComputeRangeImage(room_.scan.scan, room_.params, Execution());
  bus_.PublishAll("RIMOD_RANGE_IMAGE", ToSections(image, room_.scan.utime));
  bus_.PublishAll("RIMOD_FEATURES",
                  ToSections(ExtractFeatures(image, room_.params, Execution()), room_.scan.utime));
  ASSERT_TRUE(WaitForTold([&](const early_detections_t& told) {
    return told.utime == room_.scan.utime && told.is_final;
  })) << matcher->Output();
  bus_.ListenUntil([&] { return !bus_.Bytes("RIMOD_DETECTIONS").empty(); }, kLong);
  const auto detections = bus_.Messages<detections_t>("RIMOD_DETECTIONS");
  ASSERT_EQ(detections.size(), 1u);
  const early_detections_t last = Told().back();
  EXPECT_EQ(std::count_if(last.detections.begin(), last.detections.end(),
                          [](const early_detection_t& d) {
                            return d.status != early_detection_t::STATUS_WITHDRAWN;
                          }),
            detections[0].num_detections);

  PublishLook(2, known_until + 1);  // late: the sweep has ended
  bus_.Listen(milliseconds(1500));
  EXPECT_TRUE(Told().back().is_final);
}

TEST_F(EarlyProcessTest, ASweepOfWhichNothingMoreIsHeardIsWithdrawn) {
  const auto matcher = Start("rimod-matcher");
  GiveModel();
  PublishLook(1, room_.growths[0].end.count());
  ASSERT_TRUE(WaitForTold([](const early_detections_t& told) { return told.is_final != 0; }))
      << matcher->Output();
  const auto told = Told();
  ASSERT_EQ(told.size(), 2u);
  EXPECT_FALSE(told[0].is_final);
  for (const early_detection_t& d : told[1].detections) {
    EXPECT_EQ(d.status, early_detection_t::STATUS_WITHDRAWN);
  }
  EXPECT_TRUE(bus_.Bytes("RIMOD_DETECTIONS").empty());
}

// Clouds that come faster than they can be described: the newest are, the others are counted.
TEST_F(EarlyProcessTest, OfManyCloudsTheNewestAreDescribedAndTheOthersCounted) {
  const auto extractor = Start("rimod-extractor", {"--cloud-channel", "LIDAR", "--threads", "1"});
  const int num_clouds = 40;
  for (int i = 1; i <= num_clouds; ++i) {
    bus_.Publish("LIDAR", ToMessage(SensorCloud{Time(i), room_.scan.scan.points}, "lidar"));
    bus_.Listen(milliseconds(1));
  }
  const auto last_described = [&] {
    const auto sets = bus_.Messages<feature_set_t>("RIMOD_FEATURES");
    return sets.empty() ? 0 : sets.back().utime;
  };
  EXPECT_TRUE(bus_.ListenUntil([&] { return last_described() == num_clouds; }, kLong))
      << extractor->Output();
  ASSERT_TRUE(bus_.ListenUntil(
      [&] {
        const status_t status = *bus_.Status("rimod-extractor");
        return status.num_out + status.num_dropped == num_clouds;
      },
      kLong));
  const status_t status = *bus_.Status("rimod-extractor");
  EXPECT_EQ(CounterOf(status, "clouds"), num_clouds);
  EXPECT_EQ(CounterOf(status, "scans overtaken"), status.num_dropped);
}

}  // namespace
}  // namespace rimod
