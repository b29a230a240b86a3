#include "web_viewer/scan_history.h"

#include <gtest/gtest.h>

#include "tests/web_viewer/decoded_frame.h"

namespace rimod {
namespace {

Scan ScanOfPoints(std::size_t count) {
  Scan scan;
  scan.points.assign(count, Eigen::Vector3f(1.0f, 0.5f, 0.2f));
  return scan;
}

StampedDetections FoundAt(std::int64_t utime, std::size_t count) {
  StampedDetections detections;
  detections.utime = utime;
  detections.detections.assign(count, Detection{});
  return detections;
}

nlohmann::json HeaderOf(const ScanHistory::Part& part) { return DecodeFrame(*part.frame).header; }

TEST(ScanHistoryTest, TheNewestScanIsTheLastThatCame) {
  ScanHistory history;
  EXPECT_EQ(history.ScanPart(std::nullopt).version, 0);
  history.SetScan(100, ScanOfPoints(1));
  history.SetScan(50, ScanOfPoints(2));
  EXPECT_EQ(HeaderOf(history.ScanPart(std::nullopt))["utime"], "50");
  history.SetScan(100, ScanOfPoints(3));  // once more, as in a replay
  EXPECT_EQ(HeaderOf(history.ScanPart(std::nullopt))["num_points"], 3);
  EXPECT_EQ(HeaderOf(history.TimelinePart())["scans"].size(), 2U);
}

TEST(ScanHistoryTest, EveryChangeHasAVersionOfItsOwn) {
  ScanHistory history;
  history.SetScan(1, ScanOfPoints(1));
  const std::int64_t first = history.ScanPart(std::nullopt).version;
  history.SetScan(1, ScanOfPoints(1));
  EXPECT_NE(history.ScanPart(std::nullopt).version, first);
  const std::int64_t timeline = history.TimelinePart().version;
  history.SetDetections(FoundAt(1, 2));
  EXPECT_NE(history.TimelinePart().version, timeline);
  EXPECT_EQ(history.TimelinePart().version, history.TimelinePart().version);
}

TEST(ScanHistoryTest, DetectionsAreThoseOfTheirScan) {
  ScanHistory history;
  history.SetScan(1, ScanOfPoints(1));
  history.SetDetections(FoundAt(1, 2));
  history.SetScan(2, ScanOfPoints(1));
  const std::int64_t second = HeaderOf(history.ScanPart(std::nullopt))["id"];
  EXPECT_EQ(history.ObjectsPart(second).version, 0);
  EXPECT_EQ(HeaderOf(history.ObjectsPart(std::nullopt))["utime"], "1") << "the last that are known";
  history.SetDetections(FoundAt(2, 3));
  EXPECT_EQ(HeaderOf(history.ObjectsPart(second))["detections"].size(), 3U);
  EXPECT_EQ(HeaderOf(history.TimelinePart())["scans"][0]["num_detections"], 2);
}

TEST(ScanHistoryTest, DetectionsWithoutAScanAreKept) {
  ScanHistory history;
  history.SetDetections(FoundAt(1, 2));
  EXPECT_EQ(history.ScanPart(std::nullopt).version, 0);
  EXPECT_EQ(HeaderOf(history.ObjectsPart(std::nullopt))["detections"].size(), 2U);
}

TEST(ScanHistoryTest, ARangeImageStandsInForAScanThatDidNotCome) {
  RangeImage image({10, 10, 0.01, 0.05, 0.05}, Eigen::Isometry3d::Identity());
  image.SetMeasured(5, 5, {1600, 0, 0});
  ScanHistory history;
  history.SetRangeImage(1, image);
  EXPECT_EQ(HeaderOf(history.ScanPart(std::nullopt))["num_points"], 1);
  history.SetScan(1, ScanOfPoints(7));
  history.SetRangeImage(1, image);
  EXPECT_EQ(HeaderOf(history.ScanPart(std::nullopt))["num_points"], 7);
}

TEST(ScanHistoryTest, EarlyObjectsEndWithTheSweep) {
  StampedEarlyObjects early;
  early.utime = 1;
  early.objects.resize(2);
  ScanHistory history;
  history.SetEarlyObjects(early);
  EXPECT_EQ(HeaderOf(history.ObjectsPart(std::nullopt))["early"].size(), 2U);
  early.is_final = true;
  history.SetEarlyObjects(early);
  EXPECT_EQ(history.ObjectsPart(std::nullopt).version, 0);
}

TEST(ScanHistoryTest, KeepsSoManyScans) {
  ScanHistory history({/*max_scans=*/5, /*max_bytes=*/1'000'000'000});
  for (int i = 0; i < 50; ++i) history.SetScan(i, ScanOfPoints(10));
  const nlohmann::json scans = HeaderOf(history.TimelinePart())["scans"];
  ASSERT_EQ(scans.size(), 5U);
  EXPECT_EQ(scans[0]["utime"], "45");
  EXPECT_TRUE(history.Has(scans[0]["id"]));
  EXPECT_FALSE(history.Has(1));
}

TEST(ScanHistoryTest, KeepsSoManyBytesAndTheNewest) {
  ScanHistory history({/*max_scans=*/1000, /*max_bytes=*/200'000});
  for (int i = 0; i < 50; ++i) history.SetScan(i, ScanOfPoints(10'000));  // 60 kB each
  EXPECT_EQ(HeaderOf(history.TimelinePart())["scans"].size(), 3U);
  history.SetScan(50, ScanOfPoints(100'000));
  EXPECT_EQ(HeaderOf(history.TimelinePart())["scans"].size(), 1U);
  EXPECT_EQ(HeaderOf(history.ScanPart(std::nullopt))["utime"], "50");
}

TEST(ScanHistoryTest, NamesOfScansThatNeverComeDoNotFillIt) {
  ScanHistory history({/*max_scans=*/5, /*max_bytes=*/1'000'000});
  for (int i = 0; i < 1000; ++i) history.SetHypotheses(i, {}, 0);
  EXPECT_EQ(HeaderOf(history.TimelinePart())["scans"].size(), 5U);
}

TEST(ScanHistoryTest, TellsOfChanges) {
  ScanHistory history;
  int num_told = 0;
  history.OnChange([&] { ++num_told; });
  history.SetScan(1, ScanOfPoints(1));
  history.SetDetections(FoundAt(1, 0));
  EXPECT_EQ(num_told, 2);
}

}  // namespace
}  // namespace rimod
