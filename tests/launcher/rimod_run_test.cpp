// The real rimod-run with children that die, end and refuse to end.

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <memory>
#include <sstream>
#include <thread>

#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_matchers.h"

namespace rimod {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLong(20000);

class RimodRunTest : public testing::Test {
 protected:
  // What a child of this name runs: it notes its pid first.
  std::string Entry(const std::string& name, const std::string& script,
                    const std::string& restart = "always") {
    return "  - name: " + name + "\n    restart: " + restart +
           "\n    command: [sh, -c, 'echo $$ >> " + folder_.PathOf(name) + "; " + script + "']\n";
  }
  void Run(const std::string& entries, const std::string& settings = "") {
    const std::string file =
        folder_.Write("run.yaml", "first_pause: 0.05\n" + settings + "processes:\n" + entries);
    run_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{std::string(RIMOD_BIN_DIR) + "/rimod-run", file},
        folder_.PathOf("output"));
  }
  // The pids under which it has run so far.
  std::vector<pid_t> Pids(const std::string& name) {
    std::istringstream text(folder_.Read(name));
    std::vector<pid_t> pids;
    for (pid_t pid = 0; text >> pid;) pids.push_back(pid);
    return pids;
  }
  bool WaitForStarts(const std::string& name, std::size_t number) {
    return WaitFor([&] { return Pids(name).size() >= number; });
  }
  template <typename Condition>
  bool WaitFor(const Condition& condition) {
    const auto end = std::chrono::steady_clock::now() + kLong;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return true;
  }
  static bool IsGone(pid_t pid) { return kill(pid, 0) != 0 && errno == ESRCH; }
  bool AllGone(const std::string& name) {
    const std::vector<pid_t> pids = Pids(name);
    return std::all_of(pids.begin(), pids.end(), &IsGone);
  }

  TemporaryFolder folder_;
  std::unique_ptr<ChildProcess> run_;
};

TEST_F(RimodRunTest, AKilledChildComesBackAndTheOthersGoOn) {
  Run(Entry("a", "exec sleep 1000") + Entry("b", "exec sleep 1000"));
  ASSERT_TRUE(WaitForStarts("a", 1) && WaitForStarts("b", 1)) << run_->Output();
  for (std::size_t round = 1; round <= 3; ++round) {
    kill(Pids("a").back(), SIGKILL);
    ASSERT_TRUE(WaitForStarts("a", round + 1)) << run_->Output();
  }
  EXPECT_EQ(Pids("b").size(), 1u);
  EXPECT_FALSE(IsGone(Pids("b").back()));
  EXPECT_TRUE(Mentions(run_->Output(), {"a ended by signal 9", "starts again in 0.05 s",
                                        "starts again in 0.10 s", "starts again in 0.20 s"}));
  run_->Signal(SIGTERM);
  EXPECT_EQ(run_->Wait(kLong), 0) << run_->Output();
  EXPECT_TRUE(AllGone("a"));
  EXPECT_TRUE(AllGone("b"));
}

TEST_F(RimodRunTest, OnSignalsAllEndEvenWhatIgnoresThem) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Run(Entry("good", "exec sleep 1000") +
            Entry("deaf", "trap \"\" TERM INT; while :; do sleep 0.05; done") +
            Entry("parent", "sleep 1000 & echo $! >> " + folder_.PathOf("grandchild") + "; wait"),
        "stop_patience: 0.5\n");
    ASSERT_TRUE(WaitForStarts("good", 1) && WaitForStarts("deaf", 1) &&
                WaitForStarts("grandchild", 1));
    std::this_thread::sleep_for(milliseconds(200));  // until the deaf one has set its trap
    run_->Signal(signal);
    EXPECT_EQ(run_->Wait(kLong), 1) << run_->Output();
    EXPECT_TRUE(Mentions(run_->Output(), {"deaf still runs 0.5 s after SIGTERM: killed"}));
    EXPECT_EQ(run_->Output().find("good still runs"), std::string::npos);
    for (const std::string name : {"good", "deaf", "parent", "grandchild"})
      EXPECT_TRUE(WaitFor([&] { return AllGone(name); })) << name;
  }
}

TEST_F(RimodRunTest, WhenItIsKilledItselfItsChildrenEnd) {
  Run(Entry("a", "exec sleep 1000"));
  ASSERT_TRUE(WaitForStarts("a", 1));
  run_->Signal(SIGKILL);
  ASSERT_TRUE(run_->Wait(kLong));
  EXPECT_TRUE(WaitFor([&] { return AllGone("a"); }));
}

TEST_F(RimodRunTest, ASignalDuringAPauseEndsIt) {
  Run(Entry("a", "exit 1"), "longest_pause: 3600\n");
  ASSERT_TRUE(WaitForStarts("a", 3));
  run_->Signal(SIGTERM);
  ASSERT_TRUE(run_->Wait(kLong)) << run_->Output();
  EXPECT_TRUE(AllGone("a"));
}

TEST_F(RimodRunTest, WhatNeedNotRunAgainEndsIt) {
  Run(Entry("once", "exit 3", "never") +
      Entry("twice", "[ $(wc -l < " + folder_.PathOf("twice") + ") -gt 1 ]", "on_failure"));
  EXPECT_EQ(run_->Wait(kLong), 1) << run_->Output();
  EXPECT_EQ(Pids("once").size(), 1u);
  EXPECT_EQ(Pids("twice").size(), 2u);
  EXPECT_TRUE(Mentions(run_->Output(), {"once ended with exit code 3"}));
  Run(Entry("good", "exit 0", "on_failure"));
  EXPECT_EQ(run_->Wait(kLong), 0) << run_->Output();
}

TEST_F(RimodRunTest, BadUsageAndBadFilesEndWithTwo) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {"--nonsense"},
                                             {folder_.PathOf("missing")},
                                             {folder_.Write("bad.yaml", "x: 1\n")}}) {
    std::vector<std::string> words = {std::string(RIMOD_BIN_DIR) + "/rimod-run"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    ChildProcess process(words, folder_.PathOf("bad"));
    EXPECT_EQ(process.Wait(kLong), 2) << process.Output();
  }
}

TEST_F(RimodRunTest, TheExampleFindsItsExecutables) {
  ChildProcess process({std::string(RIMOD_BIN_DIR) + "/rimod-run", "--check",
                        std::string(RIMOD_SOURCE_DIR) + "/config/run.yaml"},
                       folder_.PathOf("check"));
  EXPECT_EQ(process.Wait(kLong), 0) << process.Output();
}

}  // namespace
}  // namespace rimod
