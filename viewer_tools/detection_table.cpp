#include "viewer_tools/detection_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace rimod {
namespace {

constexpr double kDegPerRad = 180.0 / M_PI;

using Row = std::vector<std::string>;

std::string Number(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", decimals, value);
  // No "-0.00": nobody asks on which side of zero a rounded number was.
  const bool is_zero = std::string(text).find_first_of("123456789") == std::string::npos;
  return is_zero && text[0] == '-' ? text + 1 : text;
}

// Names in messages may come from anyone: nothing of them may steer the terminal.
std::string Printable(const std::string& name) {
  constexpr std::size_t kMaxLength = 64;
  std::string text = name.substr(0, kMaxLength);
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

// The first column is flush left, the others flush right.
std::string FormatRows(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - row[i].size(), ' ');
      const bool last = i + 1 == row.size();
      text += i == 0 ? "  " + row[i] + (last ? "" : padding) : "  " + padding + row[i];
    }
    text += '\n';
  }
  return text;
}

std::string Plural(std::size_t count, const std::string& word) {
  return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

}  // namespace

double HeadingDeg(const Eigen::Isometry3d& T_local_object) {
  const Eigen::Vector3d x_axis = T_local_object.linear().col(0);
  constexpr double kVertical = 1e-6;  // shorter horizontal part: no heading to speak of
  if (x_axis.head<2>().norm() < kVertical) return 0.0;
  const double heading = std::atan2(x_axis.y(), x_axis.x()) * kDegPerRad;
  return heading <= -180.0 ? 180.0 : heading;
}

double TiltDeg(const Eigen::Isometry3d& T_local_object) {
  const Eigen::Vector3d z_axis = T_local_object.linear().col(2);
  return std::atan2(z_axis.head<2>().norm(), z_axis.z()) * kDegPerRad;
}

std::string FormatDetections(const ScanReport& report) {
  std::string text =
      Printable(report.name) + ": " + Plural(report.detections.size(), "object") + " found, " +
      Plural(static_cast<std::size_t>(std::max(report.num_models, 0)), "model") + " looked for\n";
  if (report.detections.empty()) return text;
  std::vector<Row> rows = {
      {"class", "x [m]", "y [m]", "z [m]", "heading [deg]", "tilt [deg]", "distance [m]", "score"}};
  for (const Detection& detection : report.detections) {
    const Eigen::Isometry3d& pose = detection.T_local_object;
    const Eigen::Vector3d centre = pose * (0.5 * (detection.box_min + detection.box_max));
    const Eigen::Vector3d position = pose.translation();
    rows.push_back({Printable(detection.class_name), Number(position.x(), 2),
                    Number(position.y(), 2), Number(position.z(), 2), Number(HeadingDeg(pose), 1),
                    Number(TiltDeg(pose), 1), Number((centre - report.sensor_position).norm(), 2),
                    Number(detection.score, 2)});
  }
  return text + FormatRows(rows);
}

std::string FormatStageTimes(const std::vector<ProcessTimes>& processes) {
  std::vector<Row> rows;
  for (const ProcessTimes& process : processes) {
    if (process.stage_times.empty()) continue;
    double total = 0.0;
    bool total_given = false;
    std::vector<Row> stages;
    for (const auto& [stage, ms] : process.stage_times) {
      if (stage == "total") {
        total = ms;
        total_given = true;
        continue;
      }
      if (!total_given) total += ms;
      stages.push_back({"  " + Printable(stage), Number(ms, 1)});
    }
    rows.push_back({Printable(process.process), Number(total, 1)});
    rows.insert(rows.end(), stages.begin(), stages.end());
  }
  if (rows.empty()) return "";
  rows.insert(rows.begin(), {"process and stage", "time [ms]"});
  return FormatRows(rows);
}

}  // namespace rimod
