#include "scanner_proc/simulator_process.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <thread>

#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/rigid_transform_t.hpp"
#include "io/laser_messages.h"
#include "io/raw_subscription.h"
#include "rimod/status_t.hpp"
#include "rimod/sweep_assembler.h"
#include "scanner_proc/live_scanner.h"
#include "tests/support/temporary_folder.h"

namespace rimod::simulation {
namespace {

constexpr char kScene[] = R"(
sensor: {tilt_start_deg: -20, tilt_end_deg: 20, tilt_step_deg: 2, angle_step_deg: 2, num_beams: 91}
room: {min: [-2, -2, 0], max: [3, 2, 3]}
objects: [{class: crate, box: {size: [0.5, 0.5, 0.5]}, position: [2, 0, 0]}]
)";

// Runs the process as main() does; the exit code.
int RunSimulator(std::vector<std::string> arguments) {
  CLI::App app("", "rimod-simulator");
  SimulatorOptions options;
  AddSimulatorOptions(&app, &options);
  std::vector<char*> argv = {const_cast<char*>("rimod-simulator")};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  const std::optional<int> exit_code =
      ParseCommandLine(&app, static_cast<int>(argv.size()), argv.data());
  if (exit_code) return *exit_code;
  const std::atomic<bool> stop{false};
  return SimulatorProcess(options).Run(stop);
}

TEST(SimulatorProcessTest, WritesWhatIsAskedForAndReturnsZero) {
  const TemporaryFolder folder;
  const std::string scene = folder.Write("s.yaml", kScene);
  EXPECT_EQ(
      RunSimulator({scene, "--log", folder.PathOf("s.lcm"), "--truth", folder.PathOf("s.json")}),
      0);
  EXPECT_EQ(folder.Names(), (std::vector<std::string>{"s.json", "s.lcm", "s.yaml"}));
  EXPECT_EQ(RunSimulator({scene, "--recording", folder.PathOf("r"), "--views", "2"}), 0);
  EXPECT_NE(folder.Read("r/scan_001.pcd"), "");
  EXPECT_EQ(folder.Read("r/scan_002.pcd"), "");
}

TEST(SimulatorProcessTest, UnreadableInputReturnsOne) {
  const TemporaryFolder folder;
  const std::string scene = folder.Write("s.yaml", kScene);
  const std::string log = folder.PathOf("s.lcm");
  EXPECT_EQ(RunSimulator({folder.PathOf("missing.yaml"), "--log", log}), 1);
  EXPECT_EQ(RunSimulator({folder.Write("bad.yaml", "sensor: {x: 1}"), "--log", log}), 1);
  EXPECT_EQ(RunSimulator({scene, "--log", folder.PathOf("missing/s.lcm")}), 1);
  EXPECT_EQ(RunSimulator({scene, "--log", log, "--config", folder.Write("c.yaml", "nonsense: 1")}),
            1);
  EXPECT_EQ(folder.Read("s.lcm"), "");
}

TEST(SimulatorProcessTest, BadUsageReturnsTwo) {
  const TemporaryFolder folder;
  const std::string scene = folder.Write("s.yaml", kScene);
  const std::string log = folder.PathOf("s.lcm");
  EXPECT_EQ(RunSimulator({}), 2);
  EXPECT_EQ(RunSimulator({scene, "--nonsense"}), 2);
  EXPECT_EQ(RunSimulator({scene, "--speed", "-1"}), 2);
  EXPECT_EQ(RunSimulator({scene, "--repeat", "0", "--log", log}), 2);
  EXPECT_EQ(RunSimulator({scene, "--views", "3", "--log", log}), 2);
  EXPECT_EQ(RunSimulator({scene, "--recording", folder.PathOf("r"), "--log", log}), 2);
  EXPECT_EQ(RunSimulator({scene, "--channel", "NONE=X", "--log", log}), 2);
  EXPECT_EQ(folder.Names(), std::vector<std::string>{"s.yaml"});
}

TEST(SimulatorProcessTest, SeedOfTheCommandLineCounts) {
  const TemporaryFolder folder;
  const std::string scene =
      folder.Write("s.yaml", std::string(kScene) + "noise: {range_sigma: 0.01}\nseed: 5\n");
  EXPECT_EQ(RunSimulator({scene, "--log", folder.PathOf("a")}), 0);
  EXPECT_EQ(RunSimulator({scene, "--log", folder.PathOf("b"), "--seed", "5"}), 0);
  EXPECT_EQ(RunSimulator({scene, "--log", folder.PathOf("c"), "--seed", "6"}), 0);
  EXPECT_EQ(folder.Read("a"), folder.Read("b"));
  EXPECT_NE(folder.Read("a"), folder.Read("c"));
}

// Listens on the same instance: memq:// is private to it.
struct Listener {
  explicit Listener(lcm::LCM* lcm) {
    constexpr int kQueueCapacity = 1000;
    lines = SubscribeTo<bot_core::planar_lidar_t>(
        lcm, "L", kQueueCapacity, observer, [this](const bot_core::planar_lidar_t& line) {
          ++num_lines;
          Append(assembler.AddLine(*FromMessage(line).line));
          return std::string();
        });
    poses = SubscribeTo<bot_core::rigid_transform_t>(
        lcm, "P", kQueueCapacity, observer, [this](const bot_core::rigid_transform_t& pose) {
          ++num_poses;
          Append(assembler.AddPose(*FromMessage(pose).pose));
          return std::string();
        });
    statuses = SubscribeTo<status_t>(lcm, "RIMOD_STATUS", kQueueCapacity, observer,
                                     [this](const status_t& message) {
                                       ++num_status;
                                       last_status = message;
                                       return std::string();
                                     });
  }
  void Append(std::vector<Sweep> ended) {
    for (Sweep& sweep : ended) sweeps.push_back(std::move(sweep));
  }

  SweepAssembler assembler{[] {
    SweepParams params;
    params.beams_per_line = 91;
    return params;
  }()};
  std::vector<Sweep> sweeps;
  int num_lines = 0, num_poses = 0, num_status = 0;
  status_t last_status{};
  SubscriptionObserver observer{[](const std::string&) {},
                                [](const std::string& channel, const std::string& cause) {
                                  ADD_FAILURE() << channel << ": " << cause;
                                }};
  std::unique_ptr<BytesSubscription> lines, poses, statuses;
};

Scene MakeScene() {
  Scene scene;
  scene.sensor.tilt_start = -0.4;
  scene.sensor.tilt_end = 0.4;
  scene.sensor.tilt_step = 0.04;
  scene.sensor.angle_step = 0.035;
  scene.sensor.num_beams = 91;
  Part part;
  part.shape = BoxShape{{6, 6, 3}};
  SceneObject room;
  room.parts = {part};
  scene.objects = {room};
  return scene;
}

Channels MakeChannels() {
  Channels channels;
  channels.laser = "L";
  channels.laser_to_local = "P";
  return channels;
}

TEST(LiveScannerTest, PublishesWholeSweepsThatAnAssemblerTakes) {
  lcm::LCM lcm("memq://");
  Listener listener(&lcm);
  const std::atomic<bool> stop{false};
  const LiveResult result = PublishSweeps(MakeScene(), 2, 0.0, MakeChannels(), &lcm, stop);
  while (lcm.handleTimeout(0) > 0) {
  }
  listener.Append(listener.assembler.Finish());
  EXPECT_EQ(result.num_lines, 2 * 21);
  EXPECT_EQ(result.num_failed, 0);
  EXPECT_EQ(listener.num_lines, 2 * 21);
  EXPECT_EQ(listener.num_poses, 2 * 21 + 1);
  ASSERT_EQ(listener.sweeps.size(), 2u);
  for (const Sweep& sweep : listener.sweeps) {
    EXPECT_TRUE(sweep.complete()) << sweep.incomplete_reason;
    EXPECT_EQ(sweep.num_lines, 21);
  }
  EXPECT_GE(listener.num_status, 1);
  EXPECT_EQ(listener.last_status.process, "rimod-simulator");
  EXPECT_EQ(listener.last_status.num_out, 2 * 42 + 1);
}

TEST(LiveScannerTest, KeepsTheScannersPace) {
  lcm::LCM lcm("memq://");
  const std::atomic<bool> stop{false};
  const auto start = std::chrono::steady_clock::now();
  PublishSweeps(MakeScene(), 1, 2.0, MakeChannels(), &lcm, stop);
  const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - start;
  EXPECT_GT(duration.count(), 21 * 0.02667 / 2.0 - 0.01);
}

TEST(LiveScannerTest, StopsAtOnce) {
  lcm::LCM lcm("memq://");
  std::atomic<bool> stop{false};
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    stop = true;
  });
  const auto start = std::chrono::steady_clock::now();
  PublishSweeps(MakeScene(), 0, 1.0, MakeChannels(), &lcm, stop);
  const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - start;
  stopper.join();
  EXPECT_LT(duration.count(), 5.0);
}

}  // namespace
}  // namespace rimod::simulation
