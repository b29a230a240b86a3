#include "launcher/run_file.h"

#include <gtest/gtest.h>

#include "io/files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_matchers.h"

namespace rimod {
namespace {

constexpr char kSmall[] = "processes: [{name: a, command: [sh, -c, exit]}]\n";

class RunFileTest : public testing::Test {
 protected:
  RunFileResult Read(const std::string& content) {
    return ReadRunFile(folder_.Write("run.yaml", content));
  }
  TemporaryFolder folder_;
};

TEST_F(RunFileTest, TakesWhatIsWrittenAndDefaultsForTheRest) {
  const RunFileResult result = Read(
      "processes:\n"
      "  - name: a\n    command: [sh, -c, 'exit 3', 1.50]\n"
      "  - name: b\n    command: [/bin/sh]\n    restart: on_failure\n"
      "longest_pause: 4\n");
  ASSERT_TRUE(result.run_file) << result.error;
  ASSERT_EQ(result.run_file->processes.size(), 2u);
  const RunProcess& a = result.run_file->processes[0];
  EXPECT_EQ(a.command[0].front(), '/') << "found in PATH";
  EXPECT_EQ(a.command[2], "exit 3");
  EXPECT_EQ(a.command[3], "1.50") << "words stay as they are written";
  EXPECT_EQ(a.restart, Restart::kAlways);
  EXPECT_EQ(result.run_file->processes[1].restart, Restart::kOnFailure);
  EXPECT_EQ(result.run_file->longest_pause, 4.0);
  EXPECT_EQ(result.run_file->stop_patience, RunFile().stop_patience);
}

TEST_F(RunFileTest, TheExampleIsValidAndSaysTheDefaults) {
  const FileBytes file = ReadFile(std::string(RIMOD_SOURCE_DIR) + "/config/run.yaml", 100000);
  ASSERT_TRUE(file.bytes) << file.error;
  // Its executables need not be there for this.
  std::string text(*file.bytes);
  const std::string executable = "rimod-", shell = "/bin/sh, ";
  for (auto at = text.find(executable); at != std::string::npos; at = text.find(executable, at))
    text.replace(at, executable.size(), shell);
  const RunFileResult result = Read(text);
  ASSERT_TRUE(result.run_file) << result.error;
  EXPECT_EQ(result.run_file->processes.size(), 3u);
  EXPECT_EQ(result.run_file->stop_patience, RunFile().stop_patience);
  EXPECT_EQ(result.run_file->first_pause, RunFile().first_pause);
  EXPECT_EQ(result.run_file->longest_pause, RunFile().longest_pause);
  EXPECT_EQ(result.run_file->steady_time, RunFile().steady_time);
}

TEST_F(RunFileTest, WhatIsWrongIsNamed) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "not a list of keys"},
      {"[1, 2", "run.yaml"},
      {"stop_patience: 1\n", "'processes'"},
      {"processes: []\n", "'processes'"},
      {"processes: [3]\n", "a process"},
      {"processes: [{command: [sh]}]\n", "'name'"},
      {"processes: [{name: a}]\n", "a: 'command'"},
      {"processes: [{name: a, command: sh -c x}]\n", "a: 'command'"},
      {"processes: [{name: a, command: [[sh]]}]\n", "a: 'command'"},
      {"processes: [{name: a, command: [no-such-program]}]\n", "'no-such-program'"},
      {"processes: [{name: a, command: [/etc]}]\n", "'/etc'"},
      {"processes: [{name: a, command: [sh], nice: 3}]\n", "'nice'"},
      {"processes: [{name: a, command: [sh], restart: maybe}]\n", "'maybe'"},
      {"processes: [{name: a, command: [sh]}, {name: a, command: [sh]}]\n", "'a'"},
      {std::string(kSmall) + "colour: red\n", "'colour'"},
      {std::string(kSmall) + "stop_patience: -1\n", "'stop_patience' is -1"},
      {std::string(kSmall) + "stop_patience: .nan\n", "'stop_patience' is nan"},
      {std::string(kSmall) + "first_pause: soon\n", "'first_pause'"},
      {std::string(kSmall) + "first_pause: 0\n", "'first_pause' is 0"},
      {std::string(kSmall) + "longest_pause: 0.1\n", "'longest_pause'"},
      {std::string(kSmall) + "steady_time: 1e9\n", "'steady_time'"}};
  for (const auto& [content, word] : cases) {
    const RunFileResult result = Read(content);
    EXPECT_FALSE(result.run_file) << content;
    EXPECT_TRUE(Mentions(result.error, {"run.yaml", word})) << content;
  }
  EXPECT_TRUE(Mentions(ReadRunFile(folder_.PathOf("missing")).error, {"missing"}));
}

TEST(NextPauseTest, DoublesUpToTheLongestAndBeginsAnewAfterASteadyLife) {
  RunFile run_file;
  run_file.first_pause = 1.0;
  run_file.longest_pause = 5.0;
  run_file.steady_time = 10.0;
  double pause = 0.0;
  std::vector<double> pauses;
  for (const double lived : {0.1, 0.1, 9.9, 0.1, 0.1, 10.0, 0.1}) {
    pause = NextPause(run_file, pause, lived);
    pauses.push_back(pause);
  }
  EXPECT_EQ(pauses, (std::vector<double>{1, 2, 4, 5, 5, 1, 2}));
}

}  // namespace
}  // namespace rimod
