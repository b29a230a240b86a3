#include "viewer_tools/recorded_scans.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "io/event_log.h"
#include "io/message_codec.h"
#include "io/range_image_messages.h"
#include "rimod/status_t.hpp"

namespace rimod {
namespace {

RangeImage MakeImage(int range) {
  PixelGrid grid;
  grid.width = 40;
  grid.height = 30;
  grid.resolution = 0.01;
  RangeImage image(grid, Eigen::Isometry3d::Identity());
  RoundedPixel pixel;
  pixel.range = static_cast<std::uint16_t>(range);
  image.SetMeasured(3, 4, pixel);
  return image;
}

detections_t MakeDetections(std::int64_t utime) {
  StampedDetections detections;
  detections.utime = utime;
  detections.num_models = 2;
  Detection detection;
  detection.class_name = "fan";
  detection.box_max = Eigen::Vector3d::Ones();
  detection.score = 0.5;
  detections.detections = {detection};
  return ToMessage(detections);
}

class RecordedScansTest : public testing::Test {
 protected:
  template <typename Message>
  void Write(const std::string& channel, const Message& message) {
    const std::vector<std::uint8_t> bytes = EncodeMessage(message);
    writer_.Write(++utime_, channel, bytes.data(), bytes.size());
  }
  void WriteImage(const RangeImage& image, std::int64_t utime) {
    for (const range_image_t& section : ToSections(image, utime))
      Write(channels_.range_image, section);
  }
  RecordedScansReport Read(WantedImages wanted) {
    EXPECT_EQ(writer_.Close(), "");
    RecordedScansReport report = ReadRecordedScans(
        path_, channels_, wanted, [&](RecordedScan scan) { scans_.push_back(std::move(scan)); });
    std::remove(path_.c_str());
    return report;
  }

  const std::string path_ = testing::TempDir() + "recorded_scans_test_" +
                            testing::UnitTest::GetInstance()->current_test_info()->name() + ".lcm";
  Channels channels_;
  EventLogWriter writer_{path_};
  std::int64_t utime_ = 0;
  std::vector<RecordedScan> scans_;
};

TEST_F(RecordedScansTest, DetectionsComeWithTheImageOfTheSameScan) {
  WriteImage(MakeImage(1000), 1);
  WriteImage(MakeImage(2000), 2);
  Write(channels_.detections, MakeDetections(2));
  Write(channels_.detections, MakeDetections(1));
  Write(channels_.detections, MakeDetections(3));
  const RecordedScansReport report = Read(WantedImages::kAll);
  EXPECT_EQ(report.num_scans, 3);
  EXPECT_TRUE(report.errors.empty());
  ASSERT_EQ(scans_.size(), 3u);
  ASSERT_TRUE(scans_[0].image);
  EXPECT_EQ(scans_[0].image->rounded(3, 4).range, 2000);
  ASSERT_TRUE(scans_[1].image);
  EXPECT_EQ(scans_[1].image->rounded(3, 4).range, 1000);
  EXPECT_FALSE(scans_[2].image);
  EXPECT_EQ(scans_[0].detections.detections.at(0).class_name, "fan");
}

TEST_F(RecordedScansTest, ImagesAreLeftAloneWhenNotWanted) {
  WriteImage(MakeImage(1000), 1);
  Write(channels_.detections, MakeDetections(1));
  Read(WantedImages::kNone);
  ASSERT_EQ(scans_.size(), 1u);
  EXPECT_FALSE(scans_[0].image);
}

TEST_F(RecordedScansTest, ProcessesTellTheirLastTimes) {
  for (const double ms : {7.0, 3.0}) {
    status_t status{};
    status.process = "rimod-extractor";
    status.num_stage_times = 1;
    status.stage_times.resize(1);
    status.stage_times[0].stage = "range_image";
    status.stage_times[0].ms = ms;
    Write(channels_.status, status);
  }
  const RecordedScansReport report = Read(WantedImages::kNone);
  ASSERT_EQ(report.process_times.size(), 1u);
  EXPECT_EQ(report.process_times[0].process, "rimod-extractor");
  EXPECT_DOUBLE_EQ(report.process_times[0].stage_times.at(0).second, 3.0);
}

TEST_F(RecordedScansTest, BadMessagesAreToldOnceEachCauseAndLeftOut) {
  const char garbage[] = "not a message at all";
  for (int i = 0; i < 5; ++i)
    for (const std::string& channel :
         {channels_.detections, channels_.range_image, channels_.status, std::string("FOREIGN")})
      writer_.Write(++utime_, channel, garbage, sizeof(garbage));
  detections_t broken = MakeDetections(4);
  broken.detections[0].orientation[0] = 17.0;
  Write(channels_.detections, broken);
  Write(channels_.detections, MakeDetections(5));
  const RecordedScansReport report = Read(WantedImages::kAll);
  EXPECT_EQ(report.num_scans, 1);
  EXPECT_EQ(report.errors.size(), 4u);
}

TEST_F(RecordedScansTest, ImagesWithoutDetectionsDoNotPileUp) {
  for (int i = 0; i < 40; ++i) WriteImage(MakeImage(1000), i);
  Write(channels_.detections, MakeDetections(0));
  Write(channels_.detections, MakeDetections(39));
  Read(WantedImages::kAll);
  ASSERT_EQ(scans_.size(), 2u);
  EXPECT_FALSE(scans_[0].image);
  EXPECT_TRUE(scans_[1].image);
}

TEST(RecordedScansFileTest, AMissingLogIsAnError) {
  const RecordedScansReport report = ReadRecordedScans(
      "/nowhere/log", Channels(), WantedImages::kAll, [](const RecordedScan&) { FAIL(); });
  ASSERT_EQ(report.errors.size(), 1u);
  EXPECT_NE(report.errors[0].find("/nowhere/log"), std::string::npos);
}

}  // namespace
}  // namespace rimod
