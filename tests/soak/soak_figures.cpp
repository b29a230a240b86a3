#include "tests/soak/soak_figures.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "io/status_counters.h"
#include "tests/support/bus_probe.h"

namespace rimod {
namespace {

double Percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

}  // namespace

std::string SumWithoutTimes(detections_t message) {
  message.utime = 0;
  message.stage_times.clear();
  message.num_stage_times = 0;
  return SumOf(EncodeMessage(message));
}

void SoakFigures::OnSweep(std::int64_t utime, const ExpectedScan& expected, Time last_line) {
  sweeps_[utime].expected = expected;
  sweeps_[utime].last_line = last_line;
}

void SoakFigures::DisturbWhatIsUnderWay(Time now) {
  constexpr auto kLongest = std::chrono::seconds(60);  // that a scan may take on a busy machine
  for (auto& [utime, sweep] : sweeps_)
    if (sweep.num_right == 0 && now - sweep.last_line < kLongest) sweep.disturbed = true;
}

void SoakFigures::OnFeatures(const feature_set_t& section) {
  const auto sweep = sweeps_.find(section.utime);
  if (sweep == sweeps_.end()) return;
  sweep->second.feature_sections.insert(section.section);
  sweep->second.num_feature_sections = section.num_sections;
}

void SoakFigures::OnScan(const scan_t& section) {
  const auto sweep = sweeps_.find(section.utime);
  if (sweep == sweeps_.end()) return;
  sweep->second.scan_sections.insert(section.section);
  sweep->second.num_scan_sections = section.num_sections;
  if (section.num_lines != sweep->second.expected.num_lines) sweep->second.cut = true;
}

void SoakFigures::OnDetections(const detections_t& message, Time now) {
  ++num_detections_;
  const auto found = sweeps_.find(message.utime);
  if (found == sweeps_.end()) {
    ++num_unknown_;  // of a sweep whose first lines nobody heard
    return;
  }
  SweepFigures& sweep = found->second;
  if (SumWithoutTimes(message) == sweep.expected.detections) {
    ++sweep.num_right;
    const std::chrono::duration<double, std::milli> latency = now - sweep.last_line;
    latencies_ms_.push_back(latency.count());
  } else if (sweep.cut) {
    ++num_superseded_;
  } else {
    ++sweep.num_wrong;
  }
}

void SoakFigures::OnStatus(const status_t& status) {
  auto& of_pids = processes_[status.process];
  if (of_pids.count(status.pid) == 0) {
    of_pids[status.pid].first = status;
    pids_[status.process].push_back(status.pid);
  }
  ProcessFigures& figures = of_pids[status.pid];
  // Memory is compared from the first scan that was done on.
  if (figures.first.num_out == 0) figures.first = status;
  figures.last = status;
}

int SoakFigures::PidOf(const std::string& process) const {
  const auto found = pids_.find(process);
  return found == pids_.end() ? 0 : found->second.back();
}

std::int64_t SoakFigures::Total(const std::string& process, const std::string& prefix) const {
  std::int64_t total = 0;
  for (const auto& [pid, figures] : processes_.at(process))
    for (const counter_t& counter : figures.last.counters)
      if (counter.name.rfind(prefix, 0) == 0) total += counter.value;
  return total;
}

std::map<std::string, int> SoakFigures::Missed() const {
  std::map<std::string, int> missed;
  for (const auto& [utime, sweep] : sweeps_) {
    if (sweep.disturbed || sweep.num_right > 0 || sweep.cut) continue;
    // The extractor needs no scan where it knows it ahead.
    if (sweep.has_features()) {
      ++missed["rimod-matcher"];
    } else if (sweep.has_scan()) {
      ++missed["rimod-extractor"];
    } else {
      ++missed["rimod-assembler"];
    }
  }
  return missed;
}

int SoakFigures::NumMissed() const {
  int total = 0;
  for (const auto& [process, number] : Missed()) total += number;
  return total;
}

std::string SoakFigures::Table() const {
  std::ostringstream text;
  const auto count = [this](auto condition) {
    return std::count_if(sweeps_.begin(), sweeps_.end(),
                         [&](const auto& item) { return condition(item.second); });
  };
  text << "| figure | number |\n| --- | --- |\n| sweeps played | " << sweeps_.size()
       << " |\n| of these without a fault | "
       << count([](const SweepFigures& sweep) { return !sweep.disturbed; })
       << " |\n| sweeps detected as offline, to the bit | "
       << count([](const SweepFigures& sweep) { return sweep.num_right > 0; })
       << " |\n| sweeps without a fault that were not | " << NumMissed()
       << " |\n| of these, not past | ";
  for (const auto& [process, number] : Missed()) text << process << ": " << number << "; ";
  text << " |\n| sweeps detected otherwise than offline | "
       << count([](const SweepFigures& sweep) { return sweep.num_wrong > 0; })
       << " |\n| RIMOD_DETECTIONS in all | " << num_detections_
       << " |\n| of sweeps whose beginning was lost with the assembler | " << num_unknown_
       << " |\n| of scans that a pause of the lines had cut | " << num_superseded_
       << " |\n| latency p50, p95, max from the last line | "
       << std::lround(Percentile(latencies_ms_, 0.5)) << ", "
       << std::lround(Percentile(latencies_ms_, 0.95)) << ", "
       << std::lround(Percentile(latencies_ms_, 1.0)) << " ms |\n\n"
       << "| process | killed | processes | memory kB: first scan, end, longest life | out | "
          "losses by cause |\n"
       << "| --- | --- | --- | --- | --- | --- |\n";
  for (const auto& [process, of_pids] : processes_) {
    std::map<std::string, std::int64_t> drops;
    std::int64_t num_out = 0;
    const ProcessFigures* longest = &of_pids.begin()->second;
    for (const auto& [pid, figures] : of_pids) {
      num_out += figures.last.num_out;
      if (figures.last.num_out > longest->last.num_out) longest = &figures;
      for (const counter_t& counter : figures.last.counters)
        if (counter.name.rfind(kDroppedPrefix, 0) == 0 && counter.value > 0)
          drops[counter.name.substr(sizeof kDroppedPrefix - 1)] += counter.value;
    }
    const auto kills = num_kills_.find(process);
    text << "| " << process << " | " << (kills == num_kills_.end() ? 0 : kills->second) << " | "
         << of_pids.size() << " | "
         << CounterOf(of_pids.at(pids_.at(process).front()).first, kMemoryCounter) << ", "
         << CounterOf(of_pids.at(pids_.at(process).back()).last, kMemoryCounter) << ", "
         << CounterOf(longest->first, kMemoryCounter) << " to "
         << CounterOf(longest->last, kMemoryCounter) << " in " << longest->last.num_out
         << " scans | " << num_out << " | ";
    for (const auto& [cause, number] : drops) text << cause << ": " << number << "; ";
    text << " |\n";
  }
  return text.str();
}

std::vector<std::string> SoakFigures::Failures() const {
  std::vector<std::string> failures;
  for (const auto& [utime, sweep] : sweeps_)
    if (sweep.num_wrong > 0)
      failures.push_back("scan " + std::to_string(utime) + " has other detections than offline");
  for (const auto& [process, of_pids] : processes_) {
    const std::int64_t num_rejected = Total(process, kRejectedPrefix);
    if (num_rejected > 0)
      failures.push_back(process + " rejected " + std::to_string(num_rejected) + " messages");
    for (const auto& [pid, figures] : of_pids) {
      const std::int64_t first = CounterOf(figures.first, kMemoryCounter);
      const std::int64_t last = CounterOf(figures.last, kMemoryCounter);
      constexpr std::int64_t kSlack = 40'000;  // kB
      if (last > first + first / 2 + kSlack)
        failures.push_back(process + " grew from " + std::to_string(first) + " to " +
                           std::to_string(last) + " kB");
    }
  }
  // Each of them must be told by a counter of the process that it did not get past.
  for (const auto& [process, number] : Missed()) {
    const std::int64_t num_told = processes_.count(process) ? Total(process, kDroppedPrefix) : 0;
    if (number > num_told)
      failures.push_back(std::to_string(number) + " sweeps without a fault did not get past " +
                         process + ", which tells of " + std::to_string(num_told) + " only");
  }
  const bool any = std::any_of(sweeps_.begin(), sweeps_.end(),
                               [](const auto& item) { return item.second.num_right > 0; });
  if (!any) failures.push_back("nothing was detected");
  if (!sweeps_.empty() && any) {
    const auto last = std::find_if(sweeps_.rbegin(), sweeps_.rend(),
                                   [](const auto& item) { return item.second.num_right > 0; });
    if (std::distance(sweeps_.rbegin(), last) > 3)
      failures.push_back("the last sweeps, without a fault, were not detected");
  }
  return failures;
}

}  // namespace rimod
