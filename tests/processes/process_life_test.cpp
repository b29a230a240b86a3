// How processes come, live and go: options, status, silence, restarts, ends.

#include <gtest/gtest.h>

#include <csignal>
#include <memory>

#include "io/config.h"
#include "io/event_log.h"
#include "rimod/detector.h"
#include "tests/io/random_values.h"
#include "tests/support/bus_probe.h"
#include "tests/support/child_process.h"
#include "tests/support/sample_messages.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tilting_laser.h"

namespace rimod {
namespace {

using std::chrono::milliseconds;
using Bytes = std::vector<std::uint8_t>;

constexpr milliseconds kLong(20000);

class ProcessLifeTest : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<ChildProcess> Run(const std::string& executable,
                                    std::vector<std::string> arguments = {}) {
    arguments.insert(arguments.begin(), std::string(RIMOD_BIN_DIR) + "/" + executable);
    return std::make_unique<ChildProcess>(
        arguments, folder_.PathOf(executable + std::to_string(++num_started_)));
  }
  // Starts it and waits until it speaks.
  std::unique_ptr<ChildProcess> Start(const std::string& executable,
                                      const std::vector<std::string>& arguments = {}) {
    auto process = Run(executable, arguments);
    EXPECT_TRUE(bus_.ListenUntil(
        [&] {
          const std::optional<status_t> status = bus_.Status(executable);
          return status && status->pid == process->pid();
        },
        kLong))
        << process->Output();
    return process;
  }
  std::string QuickConfig() {
    return folder_.Write("quick.yaml",
                         "bus:\n  idle_time: 0.3\n  join_patience: 0.3\n  max_waiting_scans: 5\n");
  }
  void PublishSweep(std::int64_t utime) {
    const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(utime), 60);
    for (std::size_t i = 0; i < laser.poses.size(); ++i) {
      bus_.Publish("LASER_TO_LOCAL", laser.poses[i]);
      if (i < laser.lines.size()) bus_.Publish("LASER", laser.lines[i]);
      bus_.Listen(milliseconds(1));
    }
  }
  bool WaitForDetections(std::int64_t utime) {
    return bus_.ListenUntil(
        [&] {
          const auto detections = bus_.Messages<detections_t>("RIMOD_DETECTIONS");
          return !detections.empty() && detections.back().utime == utime;
        },
        kLong);
  }

  TemporaryFolder folder_;
  BusProbe bus_;
  int num_started_ = 0;
};

TEST_P(ProcessLifeTest, HelpAndVersionEndWithZero) {
  const auto help = Run(GetParam(), {"--help"});
  EXPECT_EQ(help->Wait(kLong), 0);
  for (const std::string word : {"RIMOD_STATUS", "--config", "--lcm-url", "--channel"}) {
    EXPECT_NE(help->Output().find(word), std::string::npos) << word;
  }
  const auto version = Run(GetParam(), {"--version"});
  EXPECT_EQ(version->Wait(kLong), 0);
  EXPECT_EQ(version->Output().find(GetParam() + " "), 0u);
}

TEST_P(ProcessLifeTest, BadUsageEndsWithTwoAndSaysWhy) {
  const std::string unknown_key = folder_.Write("bad.yaml", "bus:\n  no_such_key: 1\n");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--no-such-option"}, "no-such-option"},
      {{"--channel", "LASR=X"}, "LASR"},
      {{"--channel", "LASER=A B"}, "A B"},
      {{"--config", folder_.PathOf("missing.yaml")}, "missing.yaml"},
      {{"--config", unknown_key}, "no_such_key"}};
  for (const auto& [arguments, word] : cases) {
    const auto process = Run(GetParam(), arguments);
    EXPECT_EQ(process->Wait(kLong), 2) << word;
    EXPECT_NE(process->Output().find(word), std::string::npos) << process->Output();
  }
}

TEST_P(ProcessLifeTest, WithoutARouteItSaysWhatToDoAndEndsWithOne) {
  const auto process = std::make_unique<ChildProcess>(
      std::vector<std::string>{"unshare", "-rn", std::string(RIMOD_BIN_DIR) + "/" + GetParam()},
      folder_.PathOf("no_route"));
  EXPECT_EQ(process->Wait(kLong), 1) << process->Output();
  EXPECT_NE(process->Output().find("ip route add 224.0.0.0/4"), std::string::npos)
      << process->Output();
}

TEST_P(ProcessLifeTest, SignalsEndItWithinASecondWithZero) {
  for (const int signal : {SIGTERM, SIGINT}) {
    const auto process = Start(GetParam());
    process->Signal(signal);
    EXPECT_EQ(process->Wait(milliseconds(1000)), 0) << process->Output();
    bus_.Forget();
  }
}

TEST_P(ProcessLifeTest, ASignalWhileItStartsEndsItToo) {
  for (const int delay_ms : {0, 1, 2, 5, 10, 20, 50}) {
    const auto process = Run(GetParam());
    bus_.Listen(milliseconds(delay_ms));
    process->Signal(SIGTERM);
    const std::optional<int> exit_code = process->Wait(milliseconds(3000));
    // Before main() the signal's own effect is all there is.
    EXPECT_TRUE(exit_code == 0 || exit_code == 128 + SIGTERM) << exit_code.value_or(-1);
  }
}

TEST_P(ProcessLifeTest, StatusGoesOutOnceASecond) {
  const auto process = Start(GetParam());
  bus_.Forget();
  bus_.Listen(milliseconds(4500));
  const auto statuses = bus_.Messages<status_t>("RIMOD_STATUS");
  EXPECT_GE(statuses.size(), 4u);
  EXPECT_LE(statuses.size(), 5u);
  EXPECT_EQ(statuses.at(0).process, GetParam());
  EXPECT_EQ(statuses.at(0).num_rejected, 0);
}

INSTANTIATE_TEST_SUITE_P(Each, ProcessLifeTest,
                         ::testing::Values("rimod-assembler", "rimod-extractor", "rimod-matcher"),
                         [](const auto& test) { return test.param.substr(6); });

using PipelineLifeTest = ProcessLifeTest;

TEST_F(PipelineLifeTest, EachProcessMayBeKilledAndStartedAnewWhileTheOthersRun) {
  std::map<std::string, std::unique_ptr<ChildProcess>> processes;
  const std::vector<std::string> arguments = {"--config", QuickConfig()};
  for (const std::string name : {"rimod-assembler", "rimod-extractor", "rimod-matcher"}) {
    processes[name] = Start(name, arguments);
  }
  std::int64_t utime = 1'000'000'000;
  PublishSweep(utime);
  EXPECT_TRUE(WaitForDetections(utime));
  for (auto& [name, process] : processes) {
    process->Signal(SIGKILL);
    ASSERT_TRUE(process->Wait(kLong));
    PublishSweep(utime += 10'000'000);  // is lost or not: nobody may mind
    process = Start(name, arguments);
    bus_.Listen(milliseconds(500));
    PublishSweep(utime += 10'000'000);
    EXPECT_TRUE(WaitForDetections(utime)) << "after a restart of " << name;
  }
  for (auto& [name, process] : processes) EXPECT_TRUE(process->running()) << name;
}

TEST_F(PipelineLifeTest, RenamedChannelsAreUsed) {
  const auto assembler =
      Start("rimod-assembler", {"--channel", "LASER=FRONT.LASER", "--channel",
                                "RIMOD_SCAN=FRONT.SCAN", "--config", QuickConfig()});
  const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(1'000'000'000), 60);
  bus_.PublishAll("LASER_TO_LOCAL", laser.poses);
  bus_.PublishAll("FRONT.LASER", laser.lines);
  EXPECT_TRUE(bus_.ListenUntil([&] { return !bus_.Bytes("FRONT.SCAN").empty(); }, kLong));
  EXPECT_TRUE(bus_.Bytes("RIMOD_SCAN").empty());
}

// Nothing tells the end of this sweep but that its lines stop.
TEST_F(PipelineLifeTest, AScanIsSentWhenItsLinesStopAndAgainWhenTheyGoOn) {
  const auto assembler =
      Start("rimod-assembler", {"--config", folder_.Write("patient.yaml",
                                                          "bus:\n  idle_time: 3600\nsweep:\n"
                                                          "  min_sweep_angle_deg: 1\n"
                                                          "  max_pose_gap: 10\n")});
  const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(1'000'000'000), 60);
  constexpr std::size_t kFirst = 40;
  const auto publish = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      bus_.Publish("LASER_TO_LOCAL", laser.poses[i]);
      if (i < laser.lines.size()) bus_.Publish("LASER", laser.lines[i]);
      bus_.Listen(milliseconds(2));
    }
  };
  const auto lines_sent = [&] {
    const auto sections = bus_.Messages<scan_t>("RIMOD_SCAN");
    return sections.empty() ? 0 : sections.back().num_lines;
  };
  publish(0, kFirst);
  EXPECT_TRUE(bus_.ListenUntil([&] { return lines_sent() == kFirst - 1; }, kLong));
  publish(kFirst, laser.poses.size());
  EXPECT_TRUE(bus_.ListenUntil([&] { return lines_sent() == 60; }, kLong));
  bus_.Listen(milliseconds(500));
  bus_.Forget();
  bus_.Listen(milliseconds(1000));
  EXPECT_EQ(lines_sent(), 0) << "was sent again, though nothing came";
  EXPECT_EQ(bus_.Status("rimod-assembler").value().num_dropped, 0);
}

TEST_F(PipelineLifeTest, LinesWithoutPosesAreCountedAndPosesAloneAreNoSweep) {
  const auto assembler = Start("rimod-assembler", {"--config", QuickConfig()});
  const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(1'000'000'000), 60);
  bus_.PublishAll("LASER", laser.lines);
  EXPECT_TRUE(bus_.ListenUntil(
      [&] { return CounterOf(*bus_.Status("rimod-assembler"), "lines without pose") == 60; },
      kLong));
  bus_.PublishAll("LASER_TO_LOCAL", laser.poses);
  EXPECT_TRUE(bus_.ListenUntil(
      [&] { return CounterOf(*bus_.Status("rimod-assembler"), "poses") == 61; }, kLong));
  EXPECT_TRUE(bus_.Bytes("RIMOD_SCAN").empty());
  EXPECT_TRUE(assembler->running());
}

TEST_F(PipelineLifeTest, AnImageWithoutFeaturesIsGivenUpAndCounted) {
  const auto matcher = Start("rimod-matcher", {"--config", QuickConfig()});
  bus_.PublishAll("RIMOD_RANGE_IMAGE", ToSections(RandomValues(1).AnImage(200, 100), 5));
  EXPECT_TRUE(
      bus_.ListenUntil([&] { return bus_.Status("rimod-matcher")->num_dropped == 1; }, kLong));
  EXPECT_EQ(CounterOf(*bus_.Status("rimod-matcher"), "scans without partner"), 1);
  EXPECT_TRUE(bus_.Bytes("RIMOD_DETECTIONS").empty());
}

TEST_F(PipelineLifeTest, AScanWithAMissingSectionIsGivenUpAndTheNextIsNot) {
  const auto extractor = Start("rimod-extractor", {"--config", QuickConfig()});
  StampedScan scan;
  scan.scan = RandomValues(1).AScan(20000, 0);
  scan.utime = scan.utime_end = 1;
  std::vector<scan_t> sections = ToSections(scan);
  sections.erase(sections.begin() + 1);
  bus_.PublishAll("RIMOD_SCAN", sections);
  EXPECT_TRUE(
      bus_.ListenUntil([&] { return bus_.Status("rimod-extractor")->num_dropped == 1; }, kLong));
  EXPECT_EQ(CounterOf(*bus_.Status("rimod-extractor"), "scan incomplete"), 1);
  scan.utime = scan.utime_end = 2;
  bus_.PublishAll("RIMOD_SCAN", ToSections(scan));
  EXPECT_TRUE(bus_.ListenUntil([&] { return !bus_.Bytes("RIMOD_FEATURES").empty(); }, kLong));
}

TEST_F(PipelineLifeTest, ASignalWhileManyScansWaitEndsItWithinASecond) {
  const auto extractor = Start("rimod-extractor", {"--config", QuickConfig(), "--threads", "1"});
  StampedScan scan;
  scan.scan = RandomValues(1).AScan(60000, 0);
  for (std::int64_t utime = 1; utime <= 5; ++utime) {
    scan.utime = scan.utime_end = utime;
    bus_.PublishAll("RIMOD_SCAN", ToSections(scan));
  }
  extractor->Signal(SIGTERM);
  EXPECT_EQ(extractor->Wait(milliseconds(1000)), 0) << extractor->Output();
}

TEST_F(PipelineLifeTest, AMissingModelsFolderEndsTheMatcherWithOne) {
  const auto matcher = Run("rimod-matcher", {"--models", folder_.PathOf("nowhere")});
  EXPECT_EQ(matcher->Wait(kLong), 1);
  EXPECT_NE(matcher->Output().find("nowhere"), std::string::npos) << matcher->Output();
}

TEST_F(PipelineLifeTest, ABadModelFileIsNamedAndTheMatcherLivesOn) {
  const std::string path = folder_.Write("broken.rimod", "rimod-model\nnothing");
  const auto matcher = Start("rimod-matcher", {"--models", folder_.path()});
  EXPECT_NE(matcher->Output().find(path), std::string::npos) << matcher->Output();
}

// lcm-logplayer feeds a log that EventLogWriter wrote, at ten times its speed.
TEST_F(PipelineLifeTest, TheAssemblerMakesOfAPlayedLogWhatItMakesOffline) {
  const std::int64_t begin = 1'000'000'000;
  const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(begin), 60);
  EventLogWriter writer(folder_.PathOf("log"));
  for (std::size_t i = 0; i < laser.poses.size(); ++i) {
    const Bytes pose = EncodeMessage(laser.poses[i]);
    writer.Write(laser.poses[i].utime, "LASER_TO_LOCAL", pose.data(), pose.size());
    if (i == laser.lines.size()) break;
    const Bytes line = EncodeMessage(laser.lines[i]);
    writer.Write(laser.lines[i].utime, "LASER", line.data(), line.size());
  }
  ASSERT_EQ(writer.Close(), "");

  const auto assembler = Start("rimod-assembler", {"--config", QuickConfig()});
  ChildProcess player({"lcm-logplayer", "--speed", "10", folder_.PathOf("log")},
                      folder_.PathOf("player"));
  const std::vector<Sweep> sweeps =
      Assemble(laser, DefaultConfiguration(Method::kDefault).pipeline.sweep);
  ASSERT_EQ(sweeps.size(), 1u);
  const std::vector<std::string> expected = SumsOf(
      ToSections(StampedScan{sweeps[0].begin.count(), sweeps[0].end.count(), sweeps[0].num_lines,
                             sweeps[0].num_missing_lines, sweeps[0].scan}));
  const std::int64_t utime = sweeps[0].begin.count();
  bus_.ListenUntil([&] { return bus_.Sums("RIMOD_SCAN", utime).size() >= expected.size(); }, kLong);
  EXPECT_EQ(bus_.Sums("RIMOD_SCAN", utime), expected);
  EXPECT_EQ(player.Wait(kLong), 0);
}

}  // namespace
}  // namespace rimod
