// The tools that run and watch the pipeline, with its real processes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>

#include "tests/support/bus_probe.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tilting_laser.h"

namespace rimod {
namespace {

using Json = nlohmann::json;
using std::chrono::milliseconds;

constexpr milliseconds kLong(20000);

class OperationTest : public ::testing::Test {
 protected:
  std::unique_ptr<ChildProcess> Run(const std::string& executable,
                                    std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), std::string(RIMOD_BIN_DIR) + "/" + executable);
    return std::make_unique<ChildProcess>(arguments, folder_.PathOf(executable));
  }
  // The pid of an executable's next status.
  pid_t NextPid(const std::string& executable) {
    bus_.Forget();
    bus_.ListenUntil([&] { return bus_.Status(executable).has_value(); }, kLong);
    const std::optional<status_t> status = bus_.Status(executable);
    return status ? status->pid : -1;
  }
  // What rimod-top prints, once it has listened for so long, while a sweep goes by.
  Json Watch(const std::string& seconds, bool with_sweep) {
    const auto top = Run("rimod-top", {"--once", "--json", "--listen", seconds});
    bus_.Listen(milliseconds(300));  // until it listens
    if (with_sweep) {
      const TiltingLaser laser = TiltInFrontOf(SmallRoom(), Time(1'000'000'000), 60);
      for (std::size_t i = 0; i < laser.poses.size(); ++i) {
        bus_.Publish("LASER_TO_LOCAL", laser.poses[i]);
        if (i < laser.lines.size()) bus_.Publish("LASER", laser.lines[i]);
        bus_.Listen(milliseconds(1));
      }
    }
    exit_code_ = top->Wait(kLong).value_or(-1);
    const std::string output = top->Output();
    const std::size_t begin = std::min(output.find('{'), output.size());
    return Json::parse(output.substr(begin, output.find('\n', begin) - begin), nullptr,
                       /*allow_exceptions=*/false);
  }

  TemporaryFolder folder_;
  BusProbe bus_;
  int exit_code_ = -1;
};

TEST_F(OperationTest, RimodRunBringsAKilledProcessBackAndLeavesNoneBehind) {
  const auto run = Run("rimod-run", {folder_.Write("run.yaml",
                                                   "processes:\n"
                                                   "  - {name: a, command: [rimod-assembler]}\n"
                                                   "  - {name: e, command: [rimod-extractor]}\n"
                                                   "  - {name: m, command: [rimod-matcher]}\n"
                                                   "first_pause: 0.1\n")});
  const pid_t assembler = NextPid("rimod-assembler");
  const pid_t first = NextPid("rimod-extractor");
  const pid_t matcher = NextPid("rimod-matcher");
  ASSERT_TRUE(assembler > 0 && first > 0 && matcher > 0) << run->Output();
  kill(first, SIGKILL);
  bus_.Listen(milliseconds(100));
  const pid_t second = NextPid("rimod-extractor");
  ASSERT_GT(second, 0) << run->Output();
  EXPECT_NE(second, first);
  EXPECT_EQ(NextPid("rimod-assembler"), assembler);
  run->Signal(SIGTERM);
  EXPECT_EQ(run->Wait(kLong), 0) << run->Output();
  for (const pid_t pid : {assembler, first, second, matcher})
    EXPECT_TRUE(kill(pid, 0) != 0 && errno == ESRCH) << pid;
}

TEST_F(OperationTest, RimodTopTellsProcessesChannelsAndLatency) {
  const auto assembler =
      Run("rimod-assembler", {"--config", folder_.Write("quick.yaml", "bus:\n  idle_time: 0.3\n")});
  ASSERT_EQ(NextPid("rimod-assembler"), assembler->pid());
  const Json report = Watch("4", /*with_sweep=*/true);
  EXPECT_EQ(exit_code_, 0);
  ASSERT_TRUE(report.is_object());
  ASSERT_EQ(report["processes"].size(), 1u) << report;
  const Json& process = report["processes"][0];
  EXPECT_EQ(process["process"], "rimod-assembler");
  EXPECT_EQ(process["pid"], assembler->pid());
  EXPECT_GT(process["memory_kb"], 1000);
  EXPECT_TRUE(process["cpu_share"].is_number()) << "there were two statuses at least";
  EXPECT_EQ(process["counters"]["lines"], 60);
  EXPECT_EQ(report["latency_from"], "the scan's last laser line");
  EXPECT_EQ(report["channels"][0]["messages"], 60) << report;
  EXPECT_GE(report["channels"][2]["wholes"], 1) << report;
  EXPECT_GT(report["channels"][2]["latency_ms"]["max"], 0.0) << report;
}

TEST_F(OperationTest, RimodTopSaysWhenItHearsNothing) {
  const Json report = Watch("0.2", /*with_sweep=*/false);
  EXPECT_EQ(exit_code_, 1);
  EXPECT_EQ(report["processes"], Json::array());
}

}  // namespace
}  // namespace rimod
