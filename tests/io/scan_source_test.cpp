#include "io/scan_source.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/cloud_messages.h"
#include "io/point_cloud_file.h"
#include "tests/io/laser_logs.h"
#include "tests/io/random_values.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_matchers.h"

namespace rimod {
namespace {

struct Source {
  ScanSourceReport report;
  std::vector<NamedScan> scans;

  std::string errors() const { return Join(report.errors); }
  std::string warnings() const { return Join(report.warnings); }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const NamedScan& scan : scans) names.push_back(scan.name);
    return names;
  }

 private:
  static std::string Join(const std::vector<std::string>& texts) {
    std::string joined;
    for (const std::string& text : texts) joined += text + "\n";
    return joined;
  }
};

Source Read(const std::string& path) {
  Source source;
  source.report = ReadScans(path, SweepParams(),
                            [&](NamedScan scan) { source.scans.push_back(std::move(scan)); });
  EXPECT_EQ(source.report.num_scans, static_cast<int>(source.scans.size()));
  return source;
}

std::string WriteSwingLog(const TemporaryFolder& folder, const std::string& name, int num_sweeps) {
  EventLogWriter log(folder.PathOf(name));
  WriteSwings(num_sweeps, &log);
  EXPECT_EQ(log.Close(), "");
  return folder.PathOf(name);
}

using Strings = std::vector<std::string>;

TEST(ScanSourceTest, PointCloudsAreOneScanNamedByTheFile) {
  const TemporaryFolder folder;
  const Scan scan = RandomValues(1).AScan(50, 0);
  ASSERT_EQ(WritePcd(folder.PathOf("room 7.pcd"), scan), "");
  const Source source = Read(folder.PathOf("room 7.pcd"));
  EXPECT_EQ(source.errors(), "");
  ASSERT_EQ(source.names(), Strings{"room 7"});
  EXPECT_EQ(source.scans[0].scan.points, scan.points);
  EXPECT_FALSE(source.scans[0].from_log);
}

TEST(ScanSourceTest, OneSweepHasTheLogsName) {
  const TemporaryFolder folder;
  const Source source = Read(WriteSwingLog(folder, "office.lcm", 1));
  EXPECT_EQ(source.errors(), "");
  ASSERT_EQ(source.names(), Strings{"office"});
  const NamedScan& scan = source.scans[0];
  EXPECT_TRUE(scan.from_log);
  EXPECT_GT(scan.assembly_ms, 0.0);
  EXPECT_NEAR(static_cast<double>(scan.utime), 1e6, 1e5);
  EXPECT_GT(scan.scan.points.size(), 500u);
  EXPECT_GT(scan.scan.no_return_directions.size(), 30u);
  for (const Eigen::Vector3f& point : scan.scan.points) EXPECT_NEAR(point.norm(), 5.0, 1e-4);
}

TEST(ScanSourceTest, SeveralSweepsAreNumbered) {
  const TemporaryFolder folder;
  const Source source = Read(WriteSwingLog(folder, "lcmlog-2024-01-01.00", 3));
  EXPECT_EQ(source.errors(), "");
  EXPECT_EQ(source.names(), (Strings{"lcmlog-2024-01-01.00#0", "lcmlog-2024-01-01.00#1",
                                     "lcmlog-2024-01-01.00#2"}));
  for (std::size_t i = 1; i < source.scans.size(); ++i) {
    EXPECT_GT(source.scans[i].utime, source.scans[i - 1].utime);
  }
}

TEST(ScanSourceTest, GrowthOfSweepsIsToldBeforeTheScan) {
  const TemporaryFolder folder;
  ScanSourceParams params;
  params.growth_period = 0.2;
  std::vector<std::string> told;
  params.on_growth = [&](const SweepGrowth& growth) {
    told.push_back(std::to_string(growth.sweep_begin.count()));
  };
  std::vector<std::string> scans;
  ReadScans(WriteSwingLog(folder, "two", 2), params,
            [&](const NamedScan& scan) { scans.push_back(std::to_string(scan.utime)); });
  ASSERT_EQ(scans.size(), 2u);
  for (const std::string& scan : scans) EXPECT_GE(std::count(told.begin(), told.end(), scan), 3);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
}

TEST(ScanSourceTest, PointCloudsOfALogAreScansPlacedByThePosesOfTheirCarrier) {
  const TemporaryFolder folder;
  EventLogWriter log(folder.PathOf("lidar"));
  RandomValues random(3);
  std::vector<SensorCloud> clouds;
  for (int i = 0; i < 3; ++i) {
    TimedPose pose;
    pose.time = Time(1'000'000 + i * 100'000);
    pose.T_local_laser.translation().x() = i;
    WriteMessage(&log, "BODY_TO_LOCAL", pose.time.count(), ToMessage(pose));
    SensorCloud cloud;
    cloud.time = pose.time;
    for (int k = 0; k < 10; ++k) cloud.points.push_back(random.Vector(5.0).cast<float>());
    clouds.push_back(cloud);
    WriteMessage(&log, "VELODYNE", cloud.time.count(), ToMessage(cloud, "velodyne"));
  }
  log.Write(2'000'000, "VELODYNE", "nonsense", 8);
  ASSERT_EQ(log.Close(), "");
  ScanSourceParams params;
  params.cloud_channels = {"VELODYNE", "BODY_TO_LOCAL"};
  params.cloud.mount_z = 2.0;
  Source source;
  source.report = ReadScans(folder.PathOf("lidar"), params,
                            [&](NamedScan scan) { source.scans.push_back(std::move(scan)); });
  EXPECT_EQ(source.errors(), "");
  EXPECT_TRUE(Mentions(source.warnings(), {"lidar", "1 messages", "VELODYNE"}));
  ASSERT_EQ(source.names(), (Strings{"lidar#0", "lidar#1", "lidar#2"}));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(source.scans[i].utime, clouds[i].time.count());
    const Eigen::Vector3f moved =
        clouds[i].points[4] + Eigen::Vector3f(static_cast<float>(i), 0, 2);
    EXPECT_LT((source.scans[i].scan.points.at(4) - moved).norm(), 1e-5f);
  }
  params.cloud_channels = {"OTHER", ""};
  EXPECT_TRUE(
      Mentions(ReadScans(folder.PathOf("lidar"), params, [](const NamedScan&) {}).errors.at(0),
               {"lidar", "no usable point cloud", "OTHER"}));
}

TEST(ScanSourceTest, SweepsBeforeATruncatedEndAreUsedAndTheDamageIsAnError) {
  const TemporaryFolder folder;
  WriteSwingLog(folder, "whole", 2);
  const std::string bytes = folder.Read("whole");
  const Source source = Read(folder.Write("cut", bytes.substr(0, bytes.size() * 3 / 5)));
  EXPECT_EQ(source.names(), Strings{"cut"});
  EXPECT_TRUE(Mentions(source.errors(), {"cut", "truncated"}));
  EXPECT_TRUE(Mentions(source.warnings(), {"cut", "left out a sweep"}));
}

TEST(ScanSourceTest, LogsWithoutAWholeSweepAreErrors) {
  const TemporaryFolder folder;
  WriteSwingLog(folder, "whole", 1);
  const std::string bytes = folder.Read("whole");
  const Source start = Read(folder.Write("start", bytes.substr(0, bytes.size() / 4)));
  EXPECT_TRUE(start.scans.empty());
  EXPECT_TRUE(Mentions(start.errors(), {"start", "no complete scan"}));
  const Source first = Read(folder.Write("first", bytes.substr(0, 10)));
  EXPECT_TRUE(Mentions(first.errors(), {"first", "no whole event"}));
}

TEST(ScanSourceTest, LogsOfOtherThingsNameTheirChannels) {
  const TemporaryFolder folder;
  EventLogWriter log(folder.PathOf("other"));
  log.Write(1, "POSE_BODY", "abc", 3);
  log.Write(2, "CAMERA", "abc", 3);
  ASSERT_EQ(log.Close(), "");
  EXPECT_TRUE(Mentions(Read(folder.PathOf("other")).errors(),
                       {"other", "LASER", "RIMOD_SCAN", "CAMERA, POSE_BODY"}));
}

TEST(ScanSourceTest, MessagesThatCannotBeUsedAreToldAndTheRestIsUsed) {
  const TemporaryFolder folder;
  EventLogWriter log(folder.PathOf("log"));
  log.Write(0, "LASER", "nonsense", 8);
  log.Write(0, "LASER_TO_LOCAL", "", 0);
  bot_core::planar_lidar_t lying = ToMessage(LaserLine{Time(1), 0.0, 0.1, {1.0f, 2.0f}});
  std::vector<std::uint8_t> bytes = EncodeMessage(lying);
  bytes[16] = 0x7f;  // the count of ranges: two thousand million
  log.Write(0, "LASER", bytes.data(), bytes.size());
  WriteSwings(1, &log);
  ASSERT_EQ(log.Close(), "");
  const Source source = Read(folder.PathOf("log"));
  EXPECT_EQ(source.names(), Strings{"log"});
  EXPECT_EQ(source.errors(), "");
  EXPECT_TRUE(Mentions(source.warnings(), {"log", "3 messages", "LASER"}));
}

TEST(ScanSourceTest, ReadyMadeScansOfALogAreUsedBitForBit) {
  const TemporaryFolder folder;
  RandomValues random(2);
  std::vector<StampedScan> scans;
  EventLogWriter log(folder.PathOf("scans"));
  for (int i = 0; i < 2; ++i) {
    scans.push_back({1000 * i + 7, 1000 * i + 900, 5, 0, random.AScan(12000, 3000)});
    for (const scan_t& section : ToSections(scans.back())) {
      WriteMessage(&log, "RIMOD_SCAN", section.utime, section);
    }
  }
  ASSERT_EQ(log.Close(), "");
  const Source source = Read(folder.PathOf("scans"));
  EXPECT_EQ(source.errors(), "");
  ASSERT_EQ(source.names(), (Strings{"scans#0", "scans#1"}));
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(source.scans[i].utime, scans[i].utime);
    EXPECT_EQ(source.scans[i].scan.points, scans[i].scan.points);
    EXPECT_EQ(source.scans[i].scan.no_return_directions, scans[i].scan.no_return_directions);
    EXPECT_EQ(source.scans[i].scan.T_local_sensor.matrix(), scans[i].scan.T_local_sensor.matrix());
  }
}

TEST(ScanSourceTest, ReadyMadeScansWithAMissingSectionAreLeftOut) {
  const TemporaryFolder folder;
  RandomValues random(3);
  EventLogWriter log(folder.PathOf("scans"));
  for (int i = 0; i < 2; ++i) {
    std::vector<scan_t> sections = ToSections({i, i + 1, 5, 0, random.AScan(12000, 0)});
    if (i == 0) sections.erase(sections.begin() + 1);
    for (const scan_t& section : sections) WriteMessage(&log, "RIMOD_SCAN", INT64_MAX, section);
  }
  ASSERT_EQ(log.Close(), "");
  const Source source = Read(folder.PathOf("scans"));
  EXPECT_EQ(source.names(), Strings{"scans"});
  EXPECT_TRUE(Mentions(source.warnings(), {"scans", "1 scans with missing"}));
}

TEST(ScanSourceTest, LinesArePreferredToTheScansMadeOfThem) {
  const TemporaryFolder folder;
  EventLogWriter log(folder.PathOf("all"));
  for (const scan_t& section : ToSections({1, 2, 3, 0, RandomValues(4).AScan(10, 0)})) {
    WriteMessage(&log, "RIMOD_SCAN", 1, section);
  }
  WriteSwings(1, &log);
  ASSERT_EQ(log.Close(), "");
  const Source source = Read(folder.PathOf("all"));
  ASSERT_EQ(source.names(), Strings{"all"});
  EXPECT_GT(source.scans[0].scan.points.size(), 100u);
}

TEST(ScanSourceTest, OtherFilesAreErrors) {
  const TemporaryFolder folder;
  for (const std::string& path : {folder.Write("empty", ""), folder.Write("text", "Hello"),
                                  folder.PathOf("none"), folder.path()}) {
    const Source source = Read(path);
    EXPECT_TRUE(source.scans.empty());
    EXPECT_TRUE(Mentions(source.errors(), {path}));
  }
}

}  // namespace
}  // namespace rimod
