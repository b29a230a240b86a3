#include "viewer_tools/detection_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

namespace rimod {
namespace {

constexpr double kDegPerRad = 180.0 / M_PI;

Detection MakeDetection(const std::string& name, double x, double y, double z, double heading_deg) {
  Detection detection;
  detection.class_name = name;
  detection.T_local_object.translation() = Eigen::Vector3d(x, y, z);
  detection.T_local_object.linear() =
      Eigen::AngleAxisd(heading_deg / kDegPerRad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  detection.box_min = Eigen::Vector3d(-0.2, -0.2, 0.0);
  detection.box_max = Eigen::Vector3d(0.2, 0.2, 1.0);
  detection.score = 0.834;
  return detection;
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(DetectionTableTest, HeadingIsTheAngleThatTheObjectWasTurnedBy) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> angle(-179.9, 179.9);
  for (int i = 0; i < 100; ++i) {
    const double heading = angle(generator);
    EXPECT_NEAR(HeadingDeg(MakeDetection("a", 0, 0, 0, heading).T_local_object), heading, 1e-9);
  }
  EXPECT_DOUBLE_EQ(HeadingDeg(MakeDetection("a", 0, 0, 0, -180.0).T_local_object), 180.0);
}

TEST(DetectionTableTest, HeadingOfAnUprightXAxisIsZero) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_EQ(HeadingDeg(pose), 0.0);
}

TEST(DetectionTableTest, TiltIsTheAngleFromTheVertical) {
  for (const double tilt : {0.0, 15.0, 90.0, 170.0}) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(tilt / kDegPerRad, Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
    EXPECT_NEAR(TiltDeg(pose), tilt, 1e-6);
  }
}

TEST(DetectionTableTest, ARowTellsClassPositionHeadingDistanceAndScore) {
  ScanReport report;
  report.name = "office";
  report.num_models = 7;
  report.sensor_position = Eigen::Vector3d(0.0, 0.0, 0.5);
  report.detections = {MakeDetection("fan", 3.0, 4.0, 0.0, 90.0)};
  const std::vector<std::string> lines = Lines(FormatDetections(report));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], "office: 1 object found, 7 models looked for");
  std::istringstream row(lines[2]);
  std::vector<std::string> cells;
  for (std::string cell; row >> cell;) cells.push_back(cell);
  EXPECT_EQ(cells, (std::vector<std::string>{"fan", "3.00", "4.00", "0.00", "90.0", "0.0", "5.00",
                                             "0.83"}));
}

TEST(DetectionTableTest, ColumnsLineUpWhateverTheirWidths) {
  ScanReport report;
  report.detections = {MakeDetection("a", -123.456, 0.001, -0.001, -7.0),
                       MakeDetection("a_much_longer_name", 1.0, 2.0, 3.0, 180.0)};
  const std::vector<std::string> lines = Lines(FormatDetections(report));
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[1].size(), lines[2].size());
  EXPECT_EQ(lines[2].size(), lines[3].size());
  EXPECT_EQ(lines[2].find("-0.00"), std::string::npos);
}

TEST(DetectionTableTest, NothingFoundIsALineThatSaysSo) {
  ScanReport report;
  report.name = "hall";
  EXPECT_EQ(FormatDetections(report), "hall: 0 objects found, 0 models looked for\n");
}

TEST(DetectionTableTest, NamesCannotSteerTheTerminal) {
  ScanReport report;
  report.detections = {MakeDetection("\x1b[2Jfan\n", 0, 0, 0, 0)};
  report.name = "a\rb";
  const std::string text =
      FormatDetections(report) + FormatStageTimes({{"\x1b]0;", {{"\a", 1.0}}}});
  for (const char c : text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << static_cast<int>(c);
  EXPECT_EQ(Lines(FormatDetections(report)).size(), 3u);
}

TEST(DetectionTableTest, StageTimesAreSummedForEachProcess) {
  const std::string text = FormatStageTimes(
      {{"extractor", {{"range_image", 1.25}, {"descriptors", 2.5}}}, {"idle", {}}});
  const std::vector<std::string> lines = Lines(text);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_NE(lines[1].find("extractor"), std::string::npos);
  EXPECT_NE(lines[1].find("3.8"), std::string::npos);
  EXPECT_NE(lines[3].find("2.5"), std::string::npos);
  EXPECT_EQ(text.find("idle"), std::string::npos);
}

TEST(DetectionTableTest, AGivenTotalIsTheSum) {
  const std::string text = FormatStageTimes({{"detect", {{"a", 1.0}, {"b", 1.0}, {"total", 5.0}}}});
  const std::vector<std::string> lines = Lines(text);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_NE(lines[1].find("5.0"), std::string::npos);
  EXPECT_EQ(FormatStageTimes({}), "");
}

}  // namespace
}  // namespace rimod
