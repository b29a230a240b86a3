#include "viewer_tools/detection_table.h"

#include <algorithm>
#include <cmath>

#include "viewer_tools/text_table.h"

namespace rimod {
namespace {

constexpr double kDegPerRad = 180.0 / M_PI;

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
  std::vector<TextRow> rows = {
      {"class", "x [m]", "y [m]", "z [m]", "heading [deg]", "tilt [deg]", "distance [m]", "score"}};
  for (const Detection& detection : report.detections) {
    const Eigen::Isometry3d& pose = detection.T_local_object;
    const Eigen::Vector3d centre = pose * (0.5 * (detection.box_min + detection.box_max));
    const Eigen::Vector3d position = pose.translation();
    rows.push_back({Printable(detection.class_name), FormatNumber(position.x(), 2),
                    FormatNumber(position.y(), 2), FormatNumber(position.z(), 2),
                    FormatNumber(HeadingDeg(pose), 1), FormatNumber(TiltDeg(pose), 1),
                    FormatNumber((centre - report.sensor_position).norm(), 2),
                    FormatNumber(detection.score, 2)});
  }
  return text + FormatRows(rows);
}

std::string FormatStageTimes(const std::vector<ProcessTimes>& processes) {
  std::vector<TextRow> rows;
  for (const ProcessTimes& process : processes) {
    if (process.stage_times.empty()) continue;
    double total = 0.0;
    bool total_given = false;
    std::vector<TextRow> stages;
    for (const auto& [stage, ms] : process.stage_times) {
      if (stage == "total") {
        total = ms;
        total_given = true;
        continue;
      }
      if (!total_given) total += ms;
      stages.push_back({"  " + Printable(stage), FormatNumber(ms, 1)});
    }
    rows.push_back({Printable(process.process), FormatNumber(total, 1)});
    rows.insert(rows.end(), stages.begin(), stages.end());
  }
  if (rows.empty()) return "";
  rows.insert(rows.begin(), {"process and stage", "time [ms]"});
  return FormatRows(rows);
}

}  // namespace rimod
