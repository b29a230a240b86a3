#include "viewer_tools/time_plots.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "viewer_tools/html.h"

namespace rimod {
namespace {

constexpr char kTotal[] = "total";
constexpr double kWidth = 1000.0, kHeight = 260.0;  // of the plot, SVG units
constexpr double kLeft = 60.0, kTop = 12.0, kBottom = 34.0, kRight = 12.0;

// The least of 1, 2, 5 times a power of ten that divides the span into at most so many steps.
double RoundStep(double span, int max_steps) {
  const double least = std::max(span, 1e-9) / max_steps;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10.0 * power;
}

double TimeOf(const ScanTimes& scan, const std::string& stage) {
  double sum = 0.0;
  for (const auto& [name, ms] : scan.stages)
    if (name == stage) sum += ms;
  return sum;
}

double SumOf(const ScanTimes& scan) {
  double sum = 0.0;
  for (const auto& [name, ms] : scan.stages)
    if (name != kTotal) sum += ms;
  return sum;
}

std::string Axis(double max_ms) {
  std::string svg;
  const double step = RoundStep(max_ms, 5);
  for (int k = 0; k * step <= max_ms * 1.0001; ++k) {
    const double y = kTop + kHeight * (1.0 - k * step / max_ms);
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
        kLeft, kLeft + kWidth, y, kLeft - 6, y + 4, k * step);
  }
  return svg + fmt::format("<text x=\"6\" y=\"{}\">ms</text>\n", kTop + kHeight + 24);
}

}  // namespace

std::vector<StageSummary> SummariseStages(const std::vector<ScanTimes>& scans) {
  std::vector<StageSummary> summary;
  for (const ScanTimes& scan : scans) {
    for (const auto& [name, ms] : scan.stages) {
      const bool known =
          std::any_of(summary.begin(), summary.end(),
                      [&, &n = name](const StageSummary& s) { return s.stage == n; });
      if (!known && name != kTotal) summary.push_back({name, 0.0, 0.0});
    }
  }
  for (StageSummary& stage : summary) {
    std::vector<double> times;
    times.reserve(scans.size());
    for (const ScanTimes& scan : scans) times.push_back(TimeOf(scan, stage.stage));
    std::sort(times.begin(), times.end());
    stage.median = 0.5 * (times[(times.size() - 1) / 2] + times[times.size() / 2]);
    stage.largest = times.back();
  }
  return summary;
}

std::string ColumnsSvg(const std::vector<ScanTimes>& scans) {
  const std::vector<StageSummary> stages = SummariseStages(scans);
  double max_ms = 0.0;
  for (const ScanTimes& scan : scans) max_ms = std::max(max_ms, SumOf(scan));
  if (!(max_ms > 0.0) || !std::isfinite(max_ms)) return "";
  constexpr double kMaxPitch = 90.0;
  const double pitch = std::min(kWidth / static_cast<double>(scans.size()), kMaxPitch);
  std::string svg = fmt::format(
      "<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"stage times of every "
      "scan\">\n",
      kLeft + kWidth + kRight, kTop + kHeight + kBottom);
  svg += Axis(max_ms);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const double x = kLeft + static_cast<double>(i) * pitch;
    double y = kTop + kHeight;
    svg +=
        fmt::format("<g><title>{}: {:.0f} ms</title>", EscapeHtml(scans[i].scan), SumOf(scans[i]));
    for (std::size_t k = 0; k < stages.size(); ++k) {
      const double height = kHeight * TimeOf(scans[i], stages[k].stage) / max_ms;
      y -= height;
      svg += fmt::format(
          "<rect class=\"s{}\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>", k,
          x, y, 0.85 * pitch, height);
    }
    svg += "</g>\n";
  }
  svg += fmt::format(
      "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">one column a scan, in order</text>\n</svg>\n",
      kLeft + kWidth, kTop + kHeight + 24);
  return svg;
}

}  // namespace rimod
