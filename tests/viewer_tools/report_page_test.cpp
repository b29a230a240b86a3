#include "viewer_tools/report_page.h"

#include <gtest/gtest.h>

#include "viewer_tools/time_plots.h"

namespace rimod {
namespace {

constexpr char kNasty[] = "<script>alert('x')</script>&\"";

Report MakeReport() {
  Report report;
  report.title = "a run";
  ReportScan scan;
  scan.name = "007";
  Detection detection;
  detection.class_name = "fan";
  detection.score = 0.75;
  scan.detections = {detection};
  scan.verdicts = {{Verdict::kClutter, -1}};
  scan.pictures = {{"range image", "data:image/png;base64,AAAA"}};
  scan.stage_times = {{"matching", 12.0}, {"scoring", 30.0}, {"total", 42.0}};
  report.scans = {scan};
  report.count = CountHits({{{}, {detection}}}, {{"fan", ObjectShape()}}, HitParams());
  ReportCase found;
  found.kind = CaseKind::kFalseAlarm;
  found.scan = "007";
  found.class_name = "fan";
  found.cause = "clutter";
  found.detail = "the detail";
  found.picture = "data:image/png;base64,BBBB";
  report.cases = {found};
  return report;
}

int Count(const std::string& text, const std::string& word) {
  int count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    ++count;
  return count;
}

TEST(ReportPageTest, ShowsCasesScansAndCounts) {
  const std::string page = MakeReportPage(MakeReport());
  for (const char* words : {"<h1>a run</h1>", "the detail", "007", "clutter", "BBBB", "AAAA",
                            "0.75", "matching", "false alarm"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
}

TEST(ReportPageTest, NeedsNothingButItself) {
  const std::string page = MakeReportPage(MakeReport());
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("<link"), std::string::npos);
  EXPECT_EQ(page.find("@import"), std::string::npos);
  EXPECT_EQ(page.find("url("), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos);
  for (const std::string attribute : {"src=\"", "href=\""}) {
    for (auto at = page.find(attribute); at != std::string::npos; at = page.find(attribute, at)) {
      at += attribute.size();
      EXPECT_TRUE(page.compare(at, 5, "data:") == 0 || page[at] == '#') << page.substr(at, 80);
    }
  }
}

TEST(ReportPageTest, TextsAreEscapedWherever) {
  Report report = MakeReport();
  report.title = report.cases[0].scan = report.cases[0].class_name = kNasty;
  report.cases[0].cause = report.cases[0].detail = report.cases[0].facts = kNasty;
  report.scans[0].name = report.scans[0].detections[0].class_name = kNasty;
  report.scans[0].stage_times[0].first = kNasty;
  report.scans[0].pictures[0].first = kNasty;
  report.facts = {{kNasty, kNasty}};
  report.warnings = {kNasty};
  const std::string page = MakeReportPage(report);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("alert('"), std::string::npos);
}

TEST(ReportPageTest, ElementsAreClosed) {
  const std::string page = MakeReportPage(MakeReport());
  for (const std::string tag : {"table", "tr", "td", "th", "section", "article", "details", "svg",
                                "div", "p", "g", "h2", "h3"})
    EXPECT_EQ(Count(page, "<" + tag + ">") + Count(page, "<" + tag + " "),
              Count(page, "</" + tag + ">"))
        << tag;
}

TEST(ReportPageTest, SharesOfNothingAreDashes) {
  const std::string page = MakeReportPage(MakeReport());  // one detection, no object
  EXPECT_NE(page.find("<b>&ndash;</b><span>recall</span>"), std::string::npos);
  EXPECT_NE(page.find("<b>0.000</b><span>precision</span>"), std::string::npos);
}

TEST(ReportPageTest, WithoutLabelsNothingIsSaidOfMisses) {
  Report report = MakeReport();
  report.count.reset();
  report.cases.clear();
  report.scans[0].verdicts.clear();
  const std::string page = MakeReportPage(report);
  EXPECT_NE(page.find("Without labels"), std::string::npos);
  EXPECT_EQ(page.find("<h2>Missed</h2>"), std::string::npos);
}

TEST(ReportPageTest, LightAndDarkAreTheReadersChoice) {
  EXPECT_NE(MakeReportPage({}).find("prefers-color-scheme: dark"), std::string::npos);
}

TEST(TimePlotsTest, SummaryHasMedianAndLargestWithoutTheTotal) {
  const std::vector<ScanTimes> scans = {{"a", {{"x", 1.0}, {"y", 5.0}, {"total", 6.0}}},
                                        {"b", {{"x", 3.0}, {"total", 3.0}}},
                                        {"c", {{"x", 8.0}, {"y", 1.0}}}};
  const std::vector<StageSummary> summary = SummariseStages(scans);
  ASSERT_EQ(summary.size(), 2u);
  EXPECT_EQ(summary[0].stage, "x");
  EXPECT_EQ(summary[0].median, 3.0);
  EXPECT_EQ(summary[0].largest, 8.0);
  EXPECT_EQ(summary[1].median, 1.0);  // b has none: 0
}

TEST(TimePlotsTest, ColumnsHaveAPartForEachStage) {
  const std::string svg = ColumnsSvg({{"a", {{"x", 1.0}, {"y", 5.0}}}, {"b", {{"x", 3.0}}}});
  EXPECT_EQ(Count(svg, "<rect"), 4);
  EXPECT_EQ(Count(svg, "<title>"), 2);
  EXPECT_EQ(Count(svg, "class=\"s1\""), 2);
}

TEST(TimePlotsTest, WithoutTimesThereIsNoPlot) {
  EXPECT_EQ(ColumnsSvg({}), "");
  EXPECT_EQ(ColumnsSvg({{"a", {}}}), "");
  EXPECT_EQ(ColumnsSvg({{"a", {{"x", 0.0}}}}), "");
}

}  // namespace
}  // namespace rimod
