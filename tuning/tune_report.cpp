#include "tuning/tune_report.h"

#include <spdlog/fmt/fmt.h>

namespace rimod {
namespace {

std::string CountsLine(const std::string& name, const ScanCounts& counts, double score) {
  return fmt::format("{:<18}{:>7}{:>7}{:>7}{:>9.3f}{:>11.3f}{:>9.3f}{:>9.1f}", name, counts.right,
                     counts.missed, counts.false_alarms, counts.Recall(), counts.Precision(), score,
                     counts.scans > 0 ? counts.ms / counts.scans : 0.0);
}

std::string HeadLine(const std::string& title, const std::string& objective) {
  return fmt::format("{:<18}{:>7}{:>7}{:>7}{:>9}{:>11}{:>9}{:>9}", title, "right", "missed",
                     "false", "recall", "precision", objective, "ms/scan");
}

void AddHeldOut(const TuningReport& report, std::vector<std::string>* lines) {
  const TuningResult& result = report.result;
  lines->push_back(HeadLine("in unseen scans", report.objective));
  lines->push_back(
      CountsLine("  as before", result.base_held_out, report.score(result.base_held_out)));
  lines->push_back(
      CountsLine("  tuned", result.tuned_held_out, report.score(result.tuned_held_out)));
  lines->push_back(fmt::format("gain {:+.3f}, in 90 % of resampled sets {:+.3f} .. {:+.3f}: {}",
                               result.gain.value, result.gain.low, result.gain.high,
                               result.gain.clear() ? "more than chance" : "may be chance"));
}

}  // namespace

std::vector<std::string> ChangeLines(const std::vector<Dimension>& dimensions, const Setting& from,
                                     const Setting& to) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < dimensions.size(); ++i)
    if (from[i] != to[i]) lines.push_back(dimensions[i].name + ": " + from[i] + " -> " + to[i]);
  return lines;
}

std::vector<std::string> SummaryLines(const TuningReport& report) {
  const TuningResult& result = report.result;
  std::vector<std::string> lines;
  if (result.complete) {
    AddHeldOut(report, &lines);
  } else {
    lines.push_back("interrupted: not known what the parameters are worth in unseen scans");
  }
  if (result.best < 0) return lines;
  lines.push_back(HeadLine("in all scans", report.objective));
  const int start = 0;  // the first that is tried
  for (const auto& [name, trial] :
       {std::pair("  as before", start), std::pair("  tuned", result.best)}) {
    const ScanCounts sum = report.store.Sum(trial, report.all_scans);
    lines.push_back(CountsLine(name, sum, report.score(sum)));
  }
  const std::vector<Trial>& trials = report.store.trials();
  for (const std::string& line :
       ChangeLines(report.dimensions, report.start, trials[result.best].setting))
    lines.push_back("  " + line);
  for (std::size_t fold = 0; fold < result.of_folds.size(); ++fold) {
    const Setting& setting = trials[result.of_folds[fold]].setting;
    std::string values;
    for (const std::string& value : setting) values += " " + value;
    lines.push_back(fmt::format("without fold {}:{}", fold + 1, values));
  }
  lines.push_back(fmt::format("{} settings tried, {} that cannot be combined left out",
                              trials.size(), report.store.num_invalid()));
  return lines;
}

std::string TrialsCsv(const TuningReport& report) {
  std::string csv = "trial";
  for (const Dimension& dimension : report.dimensions) csv += "," + dimension.name;
  csv += ",valid,scans,right,posed,missed,false_alarms,recall,precision,score,ms_a_scan\n";
  const std::vector<Trial>& trials = report.store.trials();
  for (std::size_t i = 0; i < trials.size(); ++i) {
    ScanCounts sum;
    for (const std::optional<ScanCounts>& counts : trials[i].counts)
      if (counts) sum += *counts;
    csv += std::to_string(i);
    for (const std::string& value : trials[i].setting) csv += "," + value;
    csv +=
        fmt::format(",{},{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.2f}\n", trials[i].valid ? 1 : 0,
                    sum.scans, sum.right, sum.posed, sum.missed, sum.false_alarms, sum.Recall(),
                    sum.Precision(), report.score(sum), sum.scans > 0 ? sum.ms / sum.scans : 0.0);
  }
  return csv;
}

}  // namespace rimod
