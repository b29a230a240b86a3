#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace rimod {

// What the stages send of a scan, in the order of the pipeline.
enum class StageOutput { kScan, kRangeImage, kFeatures, kHypotheses, kDetections };
constexpr std::size_t kNumStageOutputs = 5;

// From when latencies count, the best that was heard: the arrival of the scan's last laser line, of
// its first section on RIMOD_SCAN, or of the first message that any stage sent of it.
enum class LatencyOrigin { kLastLine, kScan, kFirstOutput };
constexpr std::size_t kNumLatencyOrigins = 3;

// Nearest-rank percentiles: p50 is the smallest latency that half of all do not exceed.
struct LatencySummary {
  double p50 = 0.0, p95 = 0.0, max = 0.0;  // s
  std::size_t num_scans = 0;               // 0: none yet
};
LatencySummary SummarizeLatencies(std::vector<double> latencies);

// One section of what a stage sent.
struct ArrivedSection {
  StageOutput output = StageOutput::kScan;
  std::int64_t utime = 0;      // us, the scan's
  std::int64_t utime_end = 0;  // us, the scan's last beam; of kScan only
  int section = 0;
  int num_sections = 1;
};

// Measures how long after a scan's end each stage's output was there, whole. Both moments are
// arrivals at one listener, on its own clock: a scanner with another clock, hosts whose clocks
// differ, and recordings played at any speed or again and again do not disturb.
class ScanLatency {
 public:
  // max_scans: the latencies of so many last scans are kept; >= 1.
  explicit ScanLatency(std::size_t max_scans) : max_scans_(max_scans) {}

  // arrival: s, on any steady clock.
  void AddLine(std::int64_t utime, double arrival);
  // True when it completed what the stage sends of the scan. Sections with impossible numbers,
  // repeated ones and those of other scans than the last 64 are left out.
  bool AddSection(const ArrivedSection& section, double arrival);

  // That of the newest scan.
  LatencyOrigin origin() const { return origin_; }
  // Latencies of this output, of scans with that origin.
  LatencySummary Summary(StageOutput output) const;

 private:
  struct Progress {
    std::vector<bool> seen;  // by section; empty: none yet
    int num_seen = 0;
    bool complete() const { return !seen.empty() && num_seen == static_cast<int>(seen.size()); }
  };
  struct Pass {
    std::int64_t utime = 0;
    StageOutput opened_by = StageOutput::kScan;
    LatencyOrigin origin = LatencyOrigin::kFirstOutput;
    double begin = 0.0;
    std::array<Progress, kNumStageOutputs> outputs;
    Progress& Of(StageOutput output) { return outputs[static_cast<std::size_t>(output)]; }
  };

  Pass* FindOrOpen(const ArrivedSection& section, double arrival);
  std::optional<double> ArrivalOfLastLine(std::int64_t utime, std::int64_t utime_end) const;

  std::size_t max_scans_;
  LatencyOrigin origin_ = LatencyOrigin::kFirstOutput;
  std::deque<std::pair<std::int64_t, double>> lines_;  // utime and arrival, as they came
  std::deque<Pass> passes_;                            // newest last
  std::array<std::array<std::deque<double>, kNumStageOutputs>, kNumLatencyOrigins> latencies_;
};

}  // namespace rimod
