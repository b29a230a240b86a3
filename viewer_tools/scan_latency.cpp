#include "viewer_tools/scan_latency.h"

#include <algorithm>
#include <cmath>

namespace rimod {
namespace {

constexpr std::size_t kMaxLines = 20000;  // some sweeps
constexpr std::size_t kMaxPasses = 64;
constexpr int kMaxSections = 4096;

}  // namespace

LatencySummary SummarizeLatencies(std::vector<double> latencies) {
  if (latencies.empty()) return {};
  std::sort(latencies.begin(), latencies.end());
  const auto percentile = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(latencies.size()));
    return latencies[static_cast<std::size_t>(rank) - 1];
  };
  return {percentile(0.5), percentile(0.95), latencies.back(), latencies.size()};
}

void ScanLatency::AddLine(std::int64_t utime, double arrival) {
  lines_.emplace_back(utime, arrival);
  if (lines_.size() > kMaxLines) lines_.pop_front();
}

bool ScanLatency::AddSection(const ArrivedSection& section, double arrival) {
  const bool possible = section.num_sections >= 1 && section.num_sections <= kMaxSections &&
                        section.section >= 0 && section.section < section.num_sections;
  if (!possible) return false;
  Pass* const pass = FindOrOpen(section, arrival);
  Progress& progress = pass->Of(section.output);
  if (progress.seen.empty()) progress.seen.resize(static_cast<std::size_t>(section.num_sections));
  const auto index = static_cast<std::size_t>(section.section);
  if (index >= progress.seen.size() || progress.seen[index]) return false;
  progress.seen[index] = true;
  ++progress.num_seen;
  if (!progress.complete()) return false;
  origin_ = pass->origin;
  std::deque<double>& latencies =
      latencies_[static_cast<std::size_t>(pass->origin)][static_cast<std::size_t>(section.output)];
  latencies.push_back(arrival - pass->begin);
  if (latencies.size() > max_scans_) latencies.pop_front();
  return true;
}

LatencySummary ScanLatency::Summary(StageOutput output) const {
  const std::deque<double>& latencies =
      latencies_[static_cast<std::size_t>(origin_)][static_cast<std::size_t>(output)];
  return SummarizeLatencies({latencies.begin(), latencies.end()});
}

// A scan that is played again comes with the utime of the first time: what opened a pass and is
// complete opens another one. What follows belongs to the newest pass that was opened in full, so
// that a single repeated section does no harm.
ScanLatency::Pass* ScanLatency::FindOrOpen(const ArrivedSection& section, double arrival) {
  Pass* found = nullptr;
  for (auto pass = passes_.rbegin(); pass != passes_.rend(); ++pass) {
    if (pass->utime != section.utime) continue;
    const bool opened_in_full = pass->Of(pass->opened_by).complete();
    if (pass->opened_by == section.output) {
      if (!opened_in_full) return &*pass;
      break;
    }
    if (found == nullptr || opened_in_full) found = &*pass;
    if (opened_in_full) break;
  }
  if (found != nullptr) return found;
  Pass pass;
  pass.utime = section.utime;
  pass.opened_by = section.output;
  pass.begin = arrival;
  if (section.output == StageOutput::kScan) {
    const std::optional<double> last_line = ArrivalOfLastLine(section.utime, section.utime_end);
    pass.origin = last_line ? LatencyOrigin::kLastLine : LatencyOrigin::kScan;
    pass.begin = last_line.value_or(arrival);
  }
  passes_.push_back(std::move(pass));
  if (passes_.size() > kMaxPasses) passes_.pop_front();
  return &passes_.back();
}

std::optional<double> ScanLatency::ArrivalOfLastLine(std::int64_t utime,
                                                     std::int64_t utime_end) const {
  for (auto line = lines_.rbegin(); line != lines_.rend(); ++line)
    if (line->first >= utime && line->first <= utime_end) return line->second;
  return std::nullopt;
}

}  // namespace rimod
