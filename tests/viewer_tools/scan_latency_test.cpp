#include "viewer_tools/scan_latency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rimod {
namespace {

constexpr std::int64_t kUtime = 1'000'000;
constexpr std::int64_t kUtimeEnd = 2'000'000;

ArrivedSection Section(StageOutput output, std::int64_t utime, int section = 0,
                       int num_sections = 1) {
  return {output, utime, utime + kUtimeEnd - kUtime, section, num_sections};
}

TEST(SummarizeLatenciesTest, PercentilesAreTheSmallestThatEnoughDoNotExceed) {
  std::mt19937 generator(1);
  for (std::size_t size = 1; size <= 200; ++size) {
    std::vector<double> latencies;
    for (std::size_t i = 0; i < size; ++i)
      latencies.push_back(std::uniform_int_distribution<int>(0, 50)(generator));
    const LatencySummary summary = SummarizeLatencies(latencies);
    const auto share_within = [&](double limit) {
      const auto within = std::count_if(latencies.begin(), latencies.end(),
                                        [limit](double latency) { return latency <= limit; });
      return static_cast<double>(within) / static_cast<double>(size);
    };
    EXPECT_GE(share_within(summary.p50), 0.5);
    EXPECT_LT(share_within(summary.p50 - 0.5), 0.5);
    EXPECT_GE(share_within(summary.p95), 0.95);
    EXPECT_LT(share_within(summary.p95 - 0.5), 0.95);
    EXPECT_EQ(summary.max, *std::max_element(latencies.begin(), latencies.end()));
    EXPECT_EQ(summary.num_scans, size);
  }
}

TEST(SummarizeLatenciesTest, NothingGivesNothing) {
  EXPECT_EQ(SummarizeLatencies({}).num_scans, 0u);
}

TEST(ScanLatencyTest, CountsFromTheLastLineToTheLastSection) {
  ScanLatency latency(10);
  latency.AddLine(kUtime, 1.0);
  latency.AddLine(kUtimeEnd - 1, 2.0);
  latency.AddLine(kUtimeEnd + 1, 3.0);  // already the next sweep
  EXPECT_FALSE(latency.AddSection(Section(StageOutput::kScan, kUtime, 1, 2), 3.5));
  EXPECT_TRUE(latency.AddSection(Section(StageOutput::kScan, kUtime, 0, 2), 4.0));
  EXPECT_FALSE(latency.AddSection(Section(StageOutput::kFeatures, kUtime, 0, 2), 4.5));
  EXPECT_EQ(latency.Summary(StageOutput::kFeatures).num_scans, 0u);
  EXPECT_TRUE(latency.AddSection(Section(StageOutput::kFeatures, kUtime, 1, 2), 5.0));
  EXPECT_TRUE(latency.AddSection(Section(StageOutput::kDetections, kUtime), 6.0));
  EXPECT_EQ(latency.origin(), LatencyOrigin::kLastLine);
  EXPECT_DOUBLE_EQ(latency.Summary(StageOutput::kScan).max, 2.0);
  EXPECT_DOUBLE_EQ(latency.Summary(StageOutput::kFeatures).max, 3.0);
  EXPECT_DOUBLE_EQ(latency.Summary(StageOutput::kDetections).p50, 4.0);
}

TEST(ScanLatencyTest, WithoutLinesItCountsFromTheFirstMessageOfTheScan) {
  ScanLatency latency(10);
  latency.AddSection(Section(StageOutput::kScan, kUtime, 0, 2), 3.0);
  latency.AddSection(Section(StageOutput::kScan, kUtime, 1, 2), 4.0);
  EXPECT_EQ(latency.origin(), LatencyOrigin::kScan);
  EXPECT_DOUBLE_EQ(latency.Summary(StageOutput::kScan).max, 1.0);
  ScanLatency matcher_alone(10);
  matcher_alone.AddSection(Section(StageOutput::kRangeImage, kUtime), 3.0);
  matcher_alone.AddSection(Section(StageOutput::kDetections, kUtime), 3.5);
  EXPECT_EQ(matcher_alone.origin(), LatencyOrigin::kFirstOutput);
  EXPECT_DOUBLE_EQ(matcher_alone.Summary(StageOutput::kDetections).max, 0.5);
}

// The clocks of the scanner and of the listener have nothing to do with each other.
TEST(ScanLatencyTest, AScanThatIsPlayedAgainCountsAgain) {
  ScanLatency latency(10);
  for (int round = 0; round < 3; ++round) {
    const double begin = 100.0 * round;
    latency.AddLine(kUtimeEnd, begin);
    EXPECT_TRUE(latency.AddSection(Section(StageOutput::kScan, kUtime), begin + 1.0));
    EXPECT_TRUE(latency.AddSection(Section(StageOutput::kDetections, kUtime), begin + 2.0 + round));
  }
  const LatencySummary summary = latency.Summary(StageOutput::kDetections);
  EXPECT_EQ(summary.num_scans, 3u);
  EXPECT_DOUBLE_EQ(summary.p50, 3.0);
  EXPECT_DOUBLE_EQ(summary.max, 4.0);
}

TEST(ScanLatencyTest, RepeatedAndImpossibleSectionsDoNoHarm) {
  ScanLatency latency(10);
  latency.AddSection(Section(StageOutput::kScan, kUtime, 0, 2), 1.0);
  EXPECT_FALSE(latency.AddSection(Section(StageOutput::kScan, kUtime, 0, 2), 2.0));
  EXPECT_FALSE(latency.AddSection(Section(StageOutput::kScan, kUtime, 7, 9), 2.0));
  EXPECT_TRUE(latency.AddSection(Section(StageOutput::kScan, kUtime, 1, 2), 3.0));
  EXPECT_FALSE(latency.AddSection(Section(StageOutput::kScan, kUtime, 0, 2), 4.0));
  for (const auto& [section, num_sections] :
       std::vector<std::pair<int, int>>{{-1, 2}, {2, 2}, {0, 0}, {0, -5}, {0, 2'000'000'000}})
    EXPECT_FALSE(
        latency.AddSection(Section(StageOutput::kFeatures, kUtime, section, num_sections), 5.0));
  EXPECT_TRUE(latency.AddSection(Section(StageOutput::kDetections, kUtime), 6.0));
  EXPECT_DOUBLE_EQ(latency.Summary(StageOutput::kScan).max, 2.0);
  EXPECT_DOUBLE_EQ(latency.Summary(StageOutput::kDetections).max, 5.0);
}

TEST(ScanLatencyTest, OnlyTheLastScansCount) {
  ScanLatency latency(2);
  for (int i = 0; i < 5; ++i) {
    const std::int64_t utime = kUtime + i;
    latency.AddSection(Section(StageOutput::kScan, utime), 10.0 * i);
    latency.AddSection(Section(StageOutput::kDetections, utime), 10.0 * i + 5 - i);
  }
  EXPECT_EQ(latency.Summary(StageOutput::kDetections).num_scans, 2u);
  EXPECT_DOUBLE_EQ(latency.Summary(StageOutput::kDetections).max, 2.0);
}

}  // namespace
}  // namespace rimod
