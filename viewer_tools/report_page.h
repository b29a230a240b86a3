#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rimod/hit_counting.h"

namespace rimod {

// The page that rimod-report writes: values in, HTML out.

// What happened at one place.
enum class CaseKind { kMiss, kFalseAlarm, kPoseOff };
// "missed", "false alarm", "pose off".
const char* CaseKindText(CaseKind kind);

struct ReportCase {
  CaseKind kind = CaseKind::kMiss;
  std::string scan;
  std::string class_name;
  std::string cause;    // a few words; cases are counted by it
  std::string detail;   // figures
  std::string facts;    // what is known of the object or the detection: "visible 55 %, 2.4 m"
  std::string picture;  // data URI; empty: none
};

struct ReportScan {
  std::string name;
  int num_measured = 0;  // pixels
  std::vector<Detection> detections;
  std::vector<CountedDetection> verdicts;  // one a detection; empty without labels
  std::vector<std::pair<std::string, std::string>> pictures;  // what it shows, data URI
  std::vector<std::pair<std::string, double>> stage_times;    // ms; empty: not known
};

struct Report {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  // how the run was made
  std::vector<std::string> warnings;
  std::optional<HitCount> count;  // absent without labels
  std::vector<ReportCase> cases;
  std::vector<ReportScan> scans;
};

// One HTML document that needs nothing but itself: no script, no link to another file. It keeps to
// the reader's choice of light or dark. All texts are escaped.
std::string MakeReportPage(const Report& report);

}  // namespace rimod
