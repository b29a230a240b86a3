#include "viewer_tools/report_sources.h"

#include <gtest/gtest.h>

#include "io/detection_messages.h"
#include "io/event_log.h"
#include "io/message_codec.h"
#include "io/point_cloud_file.h"
#include "io/range_image_messages.h"
#include "tests/support/temporary_folder.h"

namespace rimod {
namespace {

class ReportSourcesTest : public testing::Test {
 protected:
  std::vector<SourceScan> Read(const std::string& name, bool recorded) {
    std::vector<SourceScan> scans;
    report_ = ReadSource(files_.PathOf(name), Channels(), PipelineParams(), recorded,
                         [&](SourceScan scan) { scans.push_back(std::move(scan)); });
    return scans;
  }

  // A log with so many range images and detections of one object each.
  void WriteLog(const std::string& name, int num_scans) {
    PixelGrid grid;
    grid.width = 40;
    grid.height = 30;
    grid.resolution = 0.01;
    RangeImage image(grid, Eigen::Isometry3d::Identity());
    RoundedPixel pixel;
    pixel.range = 1000;
    image.SetMeasured(3, 4, pixel);
    EventLogWriter writer(files_.PathOf(name));
    std::int64_t time = 0;
    const auto write = [&](const std::string& channel, const auto& message) {
      const std::vector<std::uint8_t> bytes = EncodeMessage(message);
      writer.Write(++time, channel, bytes.data(), bytes.size());
    };
    for (int i = 1; i <= num_scans; ++i) {
      for (const range_image_t& section : ToSections(image, i))
        write(Channels().range_image, section);
      StampedDetections detections;
      detections.utime = i;
      detections.num_models = 1;
      detections.detections.resize(1);
      detections.detections[0].class_name = "fan";
      write(Channels().detections, ToMessage(detections));
    }
    ASSERT_EQ(writer.Close(), "");
  }

  TemporaryFolder files_;
  SourceReport report_;
};

TEST_F(ReportSourcesTest, LogWithDetectionsGivesThem) {
  WriteLog("run.lcm", 2);
  const std::vector<SourceScan> scans = Read("run.lcm", true);
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[0].name, "run#0");
  EXPECT_EQ(scans[1].name, "run#1");
  ASSERT_TRUE(scans[0].detections.has_value());
  EXPECT_EQ(scans[0].detections->at(0).class_name, "fan");
  EXPECT_EQ(scans[0].image.CountMeasured(), 1);
  EXPECT_TRUE(report_.errors.empty());
}

TEST_F(ReportSourcesTest, SingleScanIsNamedAsTheLog) {
  WriteLog("run.lcm", 1);
  const std::vector<SourceScan> scans = Read("run.lcm", true);
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_EQ(scans[0].name, "run");
}

TEST_F(ReportSourcesTest, ScanFileGivesItsRangeImageWithoutDetections) {
  Scan scan;
  scan.points = {{2.0f, 0.0f, 0.0f}, {2.0f, 0.5f, 0.1f}};
  ASSERT_EQ(WritePcd(files_.PathOf("x.pcd"), scan), "");
  const std::vector<SourceScan> scans = Read("x.pcd", true);
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_EQ(scans[0].name, "x");
  EXPECT_EQ(scans[0].image.CountMeasured(), 2);
  EXPECT_FALSE(scans[0].detections.has_value());
  ASSERT_FALSE(scans[0].stage_times.empty());
  EXPECT_EQ(scans[0].stage_times[0].first, "range_image");
}

TEST_F(ReportSourcesTest, MissingFileIsNamed) {
  EXPECT_TRUE(Read("nothing.pcd", true).empty());
  ASSERT_FALSE(report_.errors.empty());
  EXPECT_NE(report_.errors[0].find("nothing.pcd"), std::string::npos);
}

TEST_F(ReportSourcesTest, TimingFileIsReadInItsOrder) {
  files_.Write("t.json", R"([{"scan": "a", "points": 3, "ms": {"z": 1.5, "b": 2}}])");
  const TimingFile timing = ReadTimingFile(files_.PathOf("t.json"));
  ASSERT_EQ(timing.error, "");
  EXPECT_EQ(timing.times.at("a"), (StageTimes{{"z", 1.5}, {"b", 2.0}}));
}

TEST_F(ReportSourcesTest, OtherTimingFilesAreRefused) {
  for (const std::string text :
       {"", "{}", "[3]", R"([{"scan": "a"}])", R"([{"scan": "a", "ms": {"z": -1}}])",
        R"([{"scan": "a", "ms": {"z": "long"}}])"}) {
    files_.Write("t.json", text);
    EXPECT_NE(ReadTimingFile(files_.PathOf("t.json")).error.find("t.json"), std::string::npos)
        << text;
  }
}

}  // namespace
}  // namespace rimod
