#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "rimod/detections_t.hpp"
#include "rimod/feature_set_t.hpp"
#include "rimod/scan_t.hpp"
#include "rimod/status_t.hpp"

namespace rimod {

// What a scan of the log gives offline.
struct ExpectedScan {
  std::int32_t num_lines = 0;
  std::string detections;  // SumOf the message without utime and times
};

// The sum of a detections message without what differs from loop to loop: utime and stage times.
std::string SumWithoutTimes(detections_t message);

// Counts what goes in and comes out during a soak, and judges it at the end.
class SoakFigures {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;

  // A sweep was played to its last line; disturbed: something was killed or lost meanwhile.
  void OnSweep(std::int64_t utime, const ExpectedScan& expected, Time last_line);
  void Disturb(std::int64_t utime) { sweeps_[utime].disturbed = true; }
  // A fault now: it may cost whatever is still on its way through the pipeline, too.
  void DisturbWhatIsUnderWay(Time now);
  void OnScan(const scan_t& section);
  void OnFeatures(const feature_set_t& section);
  void OnDetections(const detections_t& message, Time now);
  void OnStatus(const status_t& status);
  void OnKill(const std::string& process) { ++num_kills_[process]; }

  // The pid under which an executable spoke last; 0: none yet.
  int PidOf(const std::string& process) const;
  // A table in markdown, and what went wrong, a line each (none: the soak is passed).
  std::string Table() const;
  std::vector<std::string> Failures() const;
  // Sweeps without a fault that were not detected (yet).
  int NumMissed() const;

 private:
  struct SweepFigures {
    ExpectedScan expected;
    Time last_line;
    bool disturbed = false;
    bool cut = false;  // a scan of other length was sent of it: its lines paused, or a restart
    int num_right = 0, num_wrong = 0;
    std::set<int> scan_sections, feature_sections;  // that were heard
    int num_scan_sections = 1, num_feature_sections = 1;
    bool has_scan() const { return static_cast<int>(scan_sections.size()) >= num_scan_sections; }
    bool has_features() const {
      return static_cast<int>(feature_sections.size()) >= num_feature_sections;
    }
  };
  struct ProcessFigures {
    status_t first, last;  // of one pid
  };
  std::int64_t Total(const std::string& process, const std::string& counter_prefix) const;
  // Sweeps without a fault that were not detected, by the process that they did not get past.
  std::map<std::string, int> Missed() const;

  std::map<std::int64_t, SweepFigures> sweeps_;  // by utime
  std::map<std::string, std::map<int, ProcessFigures>> processes_;
  std::map<std::string, std::vector<int>> pids_;  // as they came
  std::map<std::string, int> num_kills_;
  std::vector<double> latencies_ms_;
  int num_detections_ = 0, num_unknown_ = 0, num_superseded_ = 0;
};

}  // namespace rimod
