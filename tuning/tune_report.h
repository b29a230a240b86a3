#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tuning/tuner.h"

namespace rimod {

// What a report is about.
struct TuningReport {
  const TuningResult& result;
  const TrialStore& store;
  const std::vector<Dimension>& dimensions;
  const Setting& start;
  std::string objective;  // its name
  std::function<double(const ScanCounts&)> score;
  std::vector<int> all_scans;
};

// A table of all settings in the order in which they were first tried: values, in how many scans,
// counts, score over these scans.
std::string TrialsCsv(const TuningReport& report);

// Figures in scans that were not seen while choosing, and what was chosen; lines for people.
std::vector<std::string> SummaryLines(const TuningReport& report);

// "section.key: 0.07 -> 0.09" of what differs from the start.
std::vector<std::string> ChangeLines(const std::vector<Dimension>& dimensions, const Setting& from,
                                     const Setting& to);

}  // namespace rimod
