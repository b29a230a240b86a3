#include "viewer_tools/bus_watch.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "io/message_codec.h"
#include "tests/support/sample_messages.h"
#include "viewer_tools/terminal_screen.h"

namespace rimod {
namespace {

using Json = nlohmann::json;

counter_t MakeCounter(const std::string& name, std::int64_t value) {
  counter_t counter;
  counter.name = name;
  counter.value = value;
  return counter;
}

status_t MakeStatus(std::int64_t seconds, std::int64_t num_out) {
  status_t status = {};
  status.utime = seconds * 1'000'000;
  status.process = "rimod-matcher";
  status.host = "robot";
  status.pid = 7;
  status.num_out = num_out;
  status.num_dropped = 3;
  status.num_rejected = 2;
  status.counters = {MakeCounter("dropped scans overtaken", 3),
                     MakeCounter("dropped scans failed", 0),
                     MakeCounter("rejected RIMOD_MODEL: is empty", 2),
                     MakeCounter("cpu ms", 500 * seconds),
                     MakeCounter("memory kB", 2048),
                     MakeCounter("waiting scans", 1)};
  status.num_counters = static_cast<std::int32_t>(status.counters.size());
  return status;
}

class BusWatchTest : public testing::Test {
 protected:
  template <typename Message>
  void Take(const std::string& channel, const Message& message, double arrival) {
    const std::vector<std::uint8_t> bytes = EncodeMessage(message);
    watch_.Take(channel, bytes.data(), bytes.size(), arrival);
  }
  const ChannelReport& Channel(const BusReport& report, const std::string& name) {
    for (const ChannelReport& channel : report.channels)
      if (channel.channel == name) return channel;
    throw std::out_of_range(name);
  }
  BusWatch watch_{Channels(), WatchSpan::kLately};
};

TEST_F(BusWatchTest, RatesComeFromTheGrowthBetweenStatuses) {
  for (int i = 0; i <= 4; ++i) Take("RIMOD_STATUS", MakeStatus(1000 + i, 50 + 2 * i), i);
  const BusReport report = watch_.Report(4.5);
  ASSERT_EQ(report.processes.size(), 1u);
  const ProcessReport& process = report.processes[0];
  EXPECT_DOUBLE_EQ(process.out_per_second.value(), 2.0);
  EXPECT_DOUBLE_EQ(process.cpu_share.value(), 0.5);
  EXPECT_EQ(process.memory_kb, 2048);
  EXPECT_EQ(process.waiting_scans, 1);
  EXPECT_EQ(process.waiting_messages, std::nullopt);
  EXPECT_DOUBLE_EQ(process.silence, 0.5);
}

TEST_F(BusWatchTest, StagesThatNotEveryPipelineHasAreToldWhereTheyAreHeard) {
  EXPECT_EQ(FormatBusReport(watch_.Report(0.0)).find("RIMOD_SHARD"), std::string::npos);
  const auto take = [this](const std::string& channel, auto message) {
    Take(channel, message, 1.0);
    EXPECT_EQ(Channel(watch_.Report(2.0), channel).num_wholes, 1) << channel;
    EXPECT_NE(FormatBusReport(watch_.Report(2.0)).find("  " + channel), std::string::npos);
  };
  take("RIMOD_SCAN_AHEAD", SampleMessage<partial_scan_t>());
  take("RIMOD_SCAN_END", SampleMessage<scan_end_t>());
  take("RIMOD_SCAN_PARTIAL", SampleMessage<partial_scan_t>());
  take("RIMOD_RANGE_IMAGE_PARTIAL", SampleMessage<partial_range_image_t>());
  take("RIMOD_FEATURES_PARTIAL", SampleMessage<partial_feature_set_t>());
  take("RIMOD_DETECTIONS_EARLY", SampleMessage<early_detections_t>());
  take("RIMOD_MODEL", SampleMessage<object_model_t>());
  take("RIMOD_SHARDS", SampleMessage<shard_t>());
  take("RIMOD_SHARD_SCANS", SampleMessage<shard_scan_t>());
  take("RIMOD_SHARD_TURNS", SampleMessage<shard_turn_t>());
  take("RIMOD_SHARD_CANDIDATES", SampleMessage<shard_candidates_t>());
  const std::string wrong = "no message";
  watch_.Take("RIMOD_SHARDS", wrong.data(), wrong.size(), 2.0);
  EXPECT_EQ(watch_.Report(2.0).unusable.size(), 1u);
}

// Their channels are the user's own.
TEST(BusWatchCloudsTest, CloudsAreAStageWhereTheyAreNamed) {
  BusWatch watch(Channels(), WatchSpan::kAll, {"CAMERA", "CAMERA_POSE"});
  const std::vector<std::uint8_t> cloud = EncodeMessage(SampleMessage<bot_core::pointcloud2_t>());
  watch.Take("CAMERA", cloud.data(), cloud.size(), 1.0);
  EXPECT_NE(FormatBusReport(watch.Report(2.0)).find("  CAMERA "), std::string::npos);
}

TEST_F(BusWatchTest, LossesAreSortedByCause) {
  Take("RIMOD_STATUS", MakeStatus(1, 1), 0.0);
  const BusReport report = watch_.Report(0.0);
  EXPECT_EQ(report.processes[0].drops, (NamedCounts{{"scans overtaken", 3}}));
  EXPECT_EQ(report.processes[0].rejections, (NamedCounts{{"RIMOD_MODEL: is empty", 2}}));
  EXPECT_EQ(report.processes[0].counters.size(), 3u);
  const std::string text = FormatBusReport(report);
  EXPECT_NE(text.find("rimod-matcher: dropped scans overtaken"), std::string::npos) << text;
  EXPECT_NE(text.find("rimod-matcher: rejected RIMOD_MODEL: is empty"), std::string::npos) << text;
}

TEST_F(BusWatchTest, ARestartedProcessIsAnotherOneAndTheOldOneFallsSilent) {
  Take("RIMOD_STATUS", MakeStatus(1, 100), 0.0);
  status_t restarted = MakeStatus(10, 0);
  restarted.pid = 8;
  Take("RIMOD_STATUS", restarted, 9.0);
  const BusReport report = watch_.Report(9.0);
  ASSERT_EQ(report.processes.size(), 2u);
  EXPECT_EQ(report.processes[1].out_per_second, std::nullopt);
  EXPECT_NE(FormatBusReport(report).find("silent for 9 s"), std::string::npos);
}

TEST_F(BusWatchTest, WholesAreCountedAndTimed) {
  StampedScan scan;
  scan.scan = RandomValues(1).AScan(20000, 0);
  scan.utime = 1000;
  scan.utime_end = 2000;
  const std::vector<scan_t> sections = ToSections(scan);
  ASSERT_GT(sections.size(), 1u);
  Take("LASER", ToMessage(LaserLine{Time(2000), 0.1, 0.2, {1.0f, 2.0f}}), 5.0);
  for (const scan_t& section : sections) Take("RIMOD_SCAN", section, 6.0);
  StampedDetections detections;
  detections.utime = 1000;
  Take("RIMOD_DETECTIONS", ToMessage(detections), 6.5);
  const BusReport report = watch_.Report(7.0);
  EXPECT_EQ(report.origin, LatencyOrigin::kLastLine);
  const ChannelReport& scans = Channel(report, "RIMOD_SCAN");
  EXPECT_EQ(scans.num_messages, static_cast<std::int64_t>(sections.size()));
  EXPECT_EQ(scans.num_wholes, 1);
  EXPECT_DOUBLE_EQ(scans.wholes_per_second, 0.5);
  EXPECT_DOUBLE_EQ(scans.latency.value().p95, 1.0);
  EXPECT_DOUBLE_EQ(Channel(report, "RIMOD_DETECTIONS").latency.value().p50, 1.5);
  EXPECT_DOUBLE_EQ(Channel(watch_.Report(100.0), "RIMOD_SCAN").wholes_per_second, 0.0);
}

TEST_F(BusWatchTest, HostileMessagesAreCountedAndBounded) {
  for (int i = 0; i < 1000; ++i) {
    status_t status = SampleMessage<status_t>();
    status.process = "\033[2J" + std::string(1, static_cast<char>(200 + i % 50));
    status.pid = i;
    status.utime = i % 2 == 0 ? std::numeric_limits<std::int64_t>::min()
                              : std::numeric_limits<std::int64_t>::max();
    status.num_out = -(status.utime / 2);
    Take("RIMOD_STATUS", status, 0.01 * i);
    status.utime = -(status.utime / 2);
    Take("RIMOD_STATUS", status, 0.01 * i);
    for (const std::string& channel : watch_.channel_names()) watch_.Take(channel, "x", 1, 10.0);
  }
  Take("SOMETHING_ELSE", SampleMessage<scan_t>(), 10.0);
  const BusReport report = watch_.Report(10.0);
  EXPECT_LE(report.processes.size(), 64u);
  ASSERT_EQ(report.unusable.size(), watch_.channel_names().size());
  for (const auto& [cause, count] : report.unusable) EXPECT_EQ(count, 1000) << cause;
  EXPECT_EQ(FormatBusReport(report).find('\033'), std::string::npos);
  EXPECT_TRUE(Json::accept(BusReportJson(report)));
}

TEST_F(BusWatchTest, JsonHasWhatTheTablesHave) {
  Take("RIMOD_STATUS", MakeStatus(1, 10), 0.0);
  Take("RIMOD_STATUS", MakeStatus(2, 11), 1.0);
  Take("RIMOD_DETECTIONS", ToMessage(StampedDetections()), 1.0);
  const std::string text = BusReportJson(watch_.Report(2.0));
  EXPECT_EQ(text.find('\n'), text.size() - 1);
  const Json json = Json::parse(text);
  EXPECT_EQ(json["duration_s"], 2.0);
  EXPECT_EQ(json["processes"][0]["process"], "rimod-matcher");
  EXPECT_EQ(json["processes"][0]["out_per_s"], 1.0);
  EXPECT_EQ(json["processes"][0]["cpu_share"], 0.5);
  EXPECT_EQ(json["processes"][0]["waiting_messages"], Json());
  EXPECT_EQ(json["processes"][0]["drops"]["scans overtaken"], 3);
  EXPECT_EQ(json["channels"].size(), 8u);
  EXPECT_EQ(json["channels"][6]["channel"], "RIMOD_DETECTIONS");
  EXPECT_EQ(json["channels"][6]["latency_ms"]["scans"], 1);
  EXPECT_EQ(json["channels"][2]["latency_ms"], Json());
}

TEST(BusWatchOfALogTest, RatesAreThoseOfTheWholeLog) {
  BusWatch watch(Channels(), WatchSpan::kAll);
  for (int i = 0; i <= 100; ++i) {
    const std::vector<std::uint8_t> bytes = EncodeMessage(MakeStatus(i, i < 50 ? 0 : i));
    watch.Take("RIMOD_STATUS", bytes.data(), bytes.size(), 1e9 + i);
  }
  const BusReport report = watch.Report(1e9 + 100);
  EXPECT_DOUBLE_EQ(report.duration, 100.0);
  EXPECT_DOUBLE_EQ(report.processes[0].out_per_second.value(), 1.0);
  EXPECT_DOUBLE_EQ(report.channels.back().wholes_per_second, 1.01);
}

TEST(BusWatchOfALogTest, NothingHeardIsEmpty) {
  const BusWatch watch(Channels(), WatchSpan::kAll);
  EXPECT_TRUE(watch.Report(0.0).empty());
  EXPECT_TRUE(Json::accept(BusReportJson(watch.Report(0.0))));
}

TEST(CutToWindowTest, KeepsWhatFits) {
  EXPECT_EQ(CutToWindow("abcdef\ngh\nij\n", 2, 3), "abc\ngh\n");
  EXPECT_EQ(CutToWindow("a\nb", 5, 5), "a\nb\n");
  EXPECT_EQ(CutToWindow("", 5, 5), "");
}

}  // namespace
}  // namespace rimod
