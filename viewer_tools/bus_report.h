#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "viewer_tools/detection_table.h"
#include "viewer_tools/scan_latency.h"

namespace rimod {

using NamedCounts = std::vector<std::pair<std::string, std::int64_t>>;

// What one process told in its status.
struct ProcessReport {
  std::string process, host, version;
  std::int32_t pid = 0;
  double silence = 0.0;  // s, since its last status
  std::int64_t num_in = 0, num_out = 0, num_dropped = 0, num_rejected = 0;
  // Between the statuses that were heard; none after a single one.
  std::optional<double> out_per_second;
  std::optional<double> cpu_share;  // 1: one processor
  // None where the process does not tell.
  std::optional<std::int64_t> memory_kb, peak_memory_kb, waiting_scans, waiting_messages;
  NamedCounts drops, rejections;  // by cause, above 0
  NamedCounts counters;           // all others
  std::vector<std::pair<std::string, double>> stage_ms;
  std::string last_error;
};

// What came on one channel.
struct ChannelReport {
  std::string channel;
  std::int64_t num_messages = 0;
  std::int64_t num_wholes = 0;     // scans, images, .. of which every section came
  double wholes_per_second = 0.0;  // lately, or in all of a log
  double bytes_per_second = 0.0;
  std::optional<LatencySummary> latency;  // none on channels that the pipeline reads only
};

struct BusReport {
  double duration = 0.0;  // s, watched or recorded
  LatencyOrigin origin = LatencyOrigin::kFirstOutput;
  std::vector<ProcessReport> processes;  // by name, host and pid
  // In the order of the pipeline; then those that not every pipeline has, where they were heard.
  std::vector<ChannelReport> channels;
  NamedCounts unusable;  // messages, by channel and cause

  // Nothing of the pipeline was heard.
  bool empty() const;
};

// Tables for people.
std::string FormatBusReport(const BusReport& report);

// One line of JSON; docs/running.md has the keys.
std::string BusReportJson(const BusReport& report);

}  // namespace rimod
