#include "io/process_options.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <lcm/lcm-cpp.hpp>

#include "io/version.h"

namespace rimod {
namespace {

struct CommandLine {
  explicit CommandLine(std::vector<std::string> arguments)
      : app("A test.", "rimod-test"), words(std::move(arguments)) {
    words.insert(words.begin(), "rimod-test");
    AddCommonOptions(&app, &common);
    AddBusOptions(&app, &bus);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    exit_code = ParseCommandLine(&app, static_cast<int>(argv.size()), argv.data());
  }
  CLI::App app;
  std::vector<std::string> words;
  CommonOptions common;
  BusOptions bus;
  std::optional<int> exit_code;
};

TEST(ProcessOptionsTest, AllOptionsAreRead) {
  const CommandLine line({"--config", "a.yaml", "-l", "udpm://x", "--channel", "RIMOD_SCAN=SCAN_2",
                          "--channel", "LASER=FRONT"});
  EXPECT_FALSE(line.exit_code);
  EXPECT_EQ(line.common.config, "a.yaml");
  EXPECT_EQ(LcmUrl(line.bus), "udpm://x");
  const ChannelsResult channels = ChannelsFrom(line.bus);
  ASSERT_TRUE(channels.channels) << channels.error;
  EXPECT_EQ(channels.channels->scan, "SCAN_2");
  EXPECT_EQ(channels.channels->laser, "FRONT");
  EXPECT_EQ(channels.channels->range_image, "RIMOD_RANGE_IMAGE");
}

TEST(ProcessOptionsTest, HelpAndVersionGoToStdoutAndEndWithZero) {
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(CommandLine({"--version"}).exit_code, 0);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(),
            std::string("rimod-test ") + Version() + "\n");
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(CommandLine({"--help"}).exit_code, 0);
  const std::string help = ::testing::internal::GetCapturedStdout();
  for (const std::string option : {"--config", "--lcm-url", "--channel", "--version"}) {
    EXPECT_NE(help.find(option), std::string::npos) << option;
  }
}

TEST(ProcessOptionsTest, BadUsageEndsWithTwo) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(CommandLine({"--no-such-option"}).exit_code, 2);
  EXPECT_EQ(CommandLine({"--config"}).exit_code, 2);
  EXPECT_EQ(CommandLine({"word"}).exit_code, 2);
  EXPECT_FALSE(::testing::internal::GetCapturedStderr().empty());
}

TEST(ProcessOptionsTest, ACommandLineUrlGoesBeforeTheEnvironmentBeforeTheDefault) {
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(LcmUrl({"", {}}), kDefaultLcmUrl);
  setenv("LCM_DEFAULT_URL", "udpm://239.1.1.1:7000", 1);
  EXPECT_EQ(LcmUrl({"", {}}), "udpm://239.1.1.1:7000");
  EXPECT_EQ(LcmUrl({"memq://", {}}), "memq://");
  setenv("LCM_DEFAULT_URL", "", 1);
  EXPECT_EQ(LcmUrl({"", {}}), kDefaultLcmUrl);
  unsetenv("LCM_DEFAULT_URL");
}

TEST(ProcessOptionsTest, AnUrlThatCannotBeUsedGivesNothing) {
  EXPECT_EQ(OpenLcm("nonsense://"), nullptr);
  EXPECT_NE(OpenLcm("memq://"), nullptr);
}

TEST(ChannelsTest, BadRenamingsAreExplained) {
  Channels channels;
  EXPECT_EQ(RenameChannel("LASER", &channels), "'LASER' is not of the form NAME=OTHER");
  EXPECT_NE(RenameChannel("LASR=X", &channels).find("RIMOD_SCAN"), std::string::npos);
  EXPECT_NE(RenameChannel("LASER=", &channels), "");
  EXPECT_NE(RenameChannel("LASER=A B", &channels), "");
  EXPECT_NE(RenameChannel("LASER=" + std::string(64, 'A'), &channels), "");
  EXPECT_EQ(channels.laser, "LASER");
  EXPECT_EQ(RenameChannel("LASER=" + std::string(63, 'A'), &channels), "");
}

TEST(ChannelsTest, NamesMayBeSwapped) {
  Channels channels;
  EXPECT_EQ(RenameChannel("RIMOD_SCAN=LASER", &channels), "");
  EXPECT_EQ(RenameChannel("LASER=RIMOD_SCAN", &channels), "");
  EXPECT_EQ(channels.scan, "LASER");
  EXPECT_EQ(channels.laser, "RIMOD_SCAN");
}

TEST(ChannelsTest, AllDefaultNamesDiffer) {
  std::vector<std::string> names = DefaultChannelNames();
  EXPECT_EQ(names.size(), 20u);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace rimod
