#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rimod {

// Milliseconds of the stages of one scan, in the order of work.
struct ScanTimes {
  std::string scan;
  std::vector<std::pair<std::string, double>> stages;
};

// A stage over all scans, ms.
struct StageSummary {
  std::string stage;
  double median = 0.0, largest = 0.0;
};
// In the order in which stages first appear; "total" is left out. A scan without a stage counts 0.
std::vector<StageSummary> SummariseStages(const std::vector<ScanTimes>& scans);

// Inline SVG, coloured by CSS classes: a column for every scan, its stages (s0, s1 .. in the order
// of SummariseStages) on top of each other. Empty without times.
std::string ColumnsSvg(const std::vector<ScanTimes>& scans);

}  // namespace rimod
