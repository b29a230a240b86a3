#include "viewer_tools/report_page.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "viewer_tools/html.h"
#include "viewer_tools/report_style.h"
#include "viewer_tools/time_plots.h"

namespace rimod {
namespace {

constexpr char kTotal[] = "total";

// A row of cells; the first one heads it.
std::string Row(const std::vector<std::string>& cells, bool heading = false) {
  std::string row = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const char* const tag = heading || i == 0 ? "th" : "td";
    row += fmt::format("<{0}>{1}</{0}>", tag, cells[i]);
  }
  return row + "</tr>\n";
}

std::string Table(const std::vector<std::string>& rows) {
  std::string table = "<div class=\"wide\"><table>\n";
  for (const std::string& row : rows) table += row;
  return table + "</table></div>\n";
}

std::string Number(double value) {
  return std::isinf(value) ? "&infin;" : fmt::format("{:.3f}", value);
}

// A share of so many; a dash where there are none.
std::string Share(double share, int of) { return of > 0 ? Number(share) : "&ndash;"; }

std::string Count(int value) {
  return value == 0 ? "<span class=\"zero\">0</span>" : std::to_string(value);
}

std::string Card(const std::string& value, const std::string& words) {
  return fmt::format("<div class=\"card\"><b>{}</b><span>{}</span></div>\n", value,
                     EscapeHtml(words));
}

std::string Summary(const Report& report) {
  std::string html = "<div class=\"cards\">\n";
  std::size_t num_detections = 0;
  for (const ReportScan& scan : report.scans) num_detections += scan.detections.size();
  html += Card(std::to_string(report.scans.size()), "scans");
  html += Card(std::to_string(num_detections), "detections");
  if (report.count) {
    const HitCount& count = *report.count;
    html += Card(fmt::format("{} of {}", count.total.right, count.num_counted_objects),
                 "objects found");
    html += Card(std::to_string(count.total.missed), "missed");
    html += Card(std::to_string(count.total.false_alarms), "false alarms");
    const Totals& total = count.total;
    const int num_objects = count.num_counted_objects;
    html += Card(Share(total.Recall(), num_objects), "recall");
    html += Card(Share(total.Precision(), total.right + total.false_alarms), "precision");
    html +=
        Card(Share(static_cast<double>(count.num_posed) / std::max(1, num_objects), num_objects),
             "pose recall (10 cm, 15 degrees)");
    html += Card(Number(count.total.Zeta()), "zeta");
  }
  html += "</div>\n";
  std::vector<std::string> rows;
  for (const auto& [name, value] : report.facts)
    rows.push_back(Row({EscapeHtml(name), EscapeHtml(value)}));
  html += Table(rows);
  for (const std::string& warning : report.warnings)
    html += "<p class=\"warning\">" + EscapeHtml(warning) + "</p>\n";
  if (!report.count)
    html += "<p>Without labels nothing can be said of misses and false alarms.</p>\n";
  return html;
}

std::string ConfusionTable(const HitCount& count) {
  std::vector<std::string> header = {"found as"};
  for (const std::string& name : count.classes) header.push_back(EscapeHtml(name));
  header.insert(header.end(), {"clutter", "twice"});
  std::vector<std::string> rows = {Row(header, true)};
  for (const std::string& found : count.classes) {
    std::vector<std::string> cells = {EscapeHtml(found)};
    std::vector<std::string> truths = count.classes;
    truths.emplace_back();  // clutter
    for (const std::string& truth : truths) {
      const auto cell = count.confusion.find({found, truth});
      const int number = cell == count.confusion.end() ? 0 : cell->second;
      cells.push_back(found == truth ? "<b>" + Count(number) + "</b>" : Count(number));
    }
    const auto twice = count.duplicates.find(found);
    cells.push_back(Count(twice == count.duplicates.end() ? 0 : twice->second));
    rows.push_back(Row(cells));
  }
  return Table(rows);
}

std::string ClassTable(const HitCount& count) {
  std::vector<std::string> rows = {
      Row({"class", "right", "false", "missed", "recall", "precision", "zeta"}, true)};
  const auto add = [&](const std::string& name, const Totals& t) {
    rows.push_back(Row({EscapeHtml(name), Count(t.right), Count(t.false_alarms), Count(t.missed),
                        Share(t.Recall(), t.right + t.missed),
                        Share(t.Precision(), t.right + t.false_alarms), Number(t.Zeta())}));
  };
  for (const std::string& name : count.classes) {
    const auto totals = count.per_class.find(name);
    add(name, totals == count.per_class.end() ? Totals() : totals->second);
  }
  add("all", count.total);
  return Table(rows);
}

// Cases by cause and class.
std::string CauseTable(const std::vector<ReportCase>& cases) {
  std::set<std::string> classes;
  std::map<std::pair<int, std::string>, std::map<std::string, int>> causes;
  for (const ReportCase& c : cases) {
    classes.insert(c.class_name);
    std::map<std::string, int>& counts = causes[{static_cast<int>(c.kind), c.cause}];
    ++counts[c.class_name];
    ++counts[""];
  }
  std::vector<std::string> header = {"cause", "what", "all"};
  for (const std::string& name : classes) header.push_back(EscapeHtml(name));
  std::vector<std::string> rows = {Row(header, true)};
  for (const auto& [cause, counts] : causes) {
    std::vector<std::string> cells = {EscapeHtml(cause.second),
                                      CaseKindText(static_cast<CaseKind>(cause.first)),
                                      "<b>" + Count(counts.at("")) + "</b>"};
    for (const std::string& name : classes) {
      const auto number = counts.find(name);
      cells.push_back(Count(number == counts.end() ? 0 : number->second));
    }
    rows.push_back(Row(cells));
  }
  return Table(rows);
}

std::string Cases(const Report& report, CaseKind kind) {
  std::string html;
  for (const ReportCase& c : report.cases) {
    if (c.kind != kind) continue;
    html += fmt::format(
        "<article><h3>{} <span class=\"scan\">scan {}</span> <span class=\"cause\">{}</span></h3>"
        "<p>{}.</p>\n",
        EscapeHtml(c.class_name), EscapeHtml(c.scan), EscapeHtml(c.cause),
        EscapeHtml(c.detail.empty() ? c.facts : c.facts + ": " + c.detail));
    if (!c.picture.empty())
      html +=
          fmt::format("<img loading=\"lazy\" alt=\"{} in scan {}: {}\" src=\"{}\">\n",
                      EscapeHtml(c.class_name), EscapeHtml(c.scan), EscapeHtml(c.cause), c.picture);
    html += "</article>\n";
  }
  return html.empty() ? "<p>None.</p>\n" : html;
}

std::string Times(const std::vector<ReportScan>& scans) {
  std::vector<ScanTimes> times;
  for (const ReportScan& scan : scans)
    if (!scan.stage_times.empty()) times.push_back({scan.name, scan.stage_times});
  const std::string columns = ColumnsSvg(times);
  if (columns.empty()) return "<p>The run did not tell them.</p>\n";
  std::vector<std::string> rows = {Row({"stage", "median", "largest", "ms"}, true)};
  const std::vector<StageSummary> stages = SummariseStages(times);
  double longest = 1e-9;
  for (const StageSummary& stage : stages) longest = std::max(longest, stage.median);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const std::string bar = fmt::format(
        "<svg class=\"bar\" viewBox=\"0 0 200 12\"><rect class=\"s{}\" width=\"{:.1f}\" "
        "height=\"12\"/></svg>",
        i, 200.0 * stages[i].median / longest);
    rows.push_back(Row({EscapeHtml(stages[i].stage), fmt::format("{:.1f}", stages[i].median),
                        fmt::format("{:.1f}", stages[i].largest), bar}));
  }
  return columns + Table(rows);
}

std::string DetectionTable(const ReportScan& scan) {
  if (scan.detections.empty()) return "<p>Nothing was found.</p>\n";
  std::vector<std::string> rows = {Row({"class", "score", "x, y, z (m)", "verdict"}, true)};
  for (std::size_t i = 0; i < scan.detections.size(); ++i) {
    const Detection& d = scan.detections[i];
    const Eigen::Vector3d p = d.T_local_object.translation();
    rows.push_back(Row({EscapeHtml(d.class_name), fmt::format("{:.2f}", d.score),
                        fmt::format("{:.2f}, {:.2f}, {:.2f}", p.x(), p.y(), p.z()),
                        i < scan.verdicts.size() ? VerdictText(scan.verdicts[i].verdict) : ""}));
  }
  return Table(rows);
}

std::string Scans(const std::vector<ReportScan>& scans) {
  std::string html;
  for (const ReportScan& scan : scans) {
    double ms = 0.0;
    for (const auto& [stage, stage_ms] : scan.stage_times)
      if (stage != kTotal) ms += stage_ms;
    const std::string time = ms > 0.0 ? fmt::format(", {:.0f} ms", ms) : "";
    html += fmt::format(
        "<details{}><summary>{} <span class=\"scan\">{} measured pixels, {} found{}"
        "</span></summary>\n",
        scans.size() == 1 ? " open" : "", EscapeHtml(scan.name), scan.num_measured,
        scan.detections.size(), time);
    html += DetectionTable(scan);
    for (const auto& [what, picture] : scan.pictures)
      html += fmt::format("<img loading=\"lazy\" alt=\"{}\" src=\"{}\">\n",
                          EscapeHtml(scan.name + ": " + what), picture);
    html += "</details>\n";
  }
  return html;
}

std::string Section(const std::string& heading, const std::string& body) {
  return "<section><h2>" + EscapeHtml(heading) + "</h2>\n" + body + "</section>\n";
}

}  // namespace

const char* CaseKindText(CaseKind kind) {
  switch (kind) {
    case CaseKind::kMiss:
      return "missed";
    case CaseKind::kFalseAlarm:
      return "false alarm";
    case CaseKind::kPoseOff:
      break;
  }
  return "pose off";
}

std::string MakeReportPage(const Report& report) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
      EscapeHtml(report.title) + "</title>\n<style>" + kReportStyle + "</style></head>\n<body>\n" +
      "<h1>" + EscapeHtml(report.title) + "</h1>\n";
  html += Section("Summary", Summary(report));
  if (report.count) {
    html += Section("Causes", report.cases.empty() ? "<p>No case.</p>" : CauseTable(report.cases));
    html += Section("Confusion", ConfusionTable(*report.count) + ClassTable(*report.count));
    html += Section("Missed", Cases(report, CaseKind::kMiss));
    html += Section("False alarms", Cases(report, CaseKind::kFalseAlarm));
    html +=
        Section("Found, but more than 10 cm or 15 degrees off", Cases(report, CaseKind::kPoseOff));
  }
  html += Section("Stage times", Times(report.scans));
  html += Section("Scans", Scans(report.scans));
  return html + "</body></html>\n";
}

}  // namespace rimod
