#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rimod/detection.h"

namespace rimod {

// What a table says of one scan.
struct ScanReport {
  std::string name;
  int num_models = 0;                                         // that were looked for
  Eigen::Vector3d sensor_position = Eigen::Vector3d::Zero();  // m, local frame
  std::vector<Detection> detections;
};

// How long a process took for its stages: stage and milliseconds.
struct ProcessTimes {
  std::string process;
  std::vector<std::pair<std::string, double>> stage_times;
};

// Heading of an object: the angle of its x-axis about the local z from the local x, degrees, more
// than -180 to 180. 0 where its x-axis is vertical.
double HeadingDeg(const Eigen::Isometry3d& T_local_object);

// Angle between the object's and the local z-axis, degrees, 0 to 180.
double TiltDeg(const Eigen::Isometry3d& T_local_object);

// A title and a line for each detection: class, position (m, local frame), heading, tilt (degrees),
// distance of the box's centre from the sensor (m), score. Columns are as wide as their widest
// entry.
std::string FormatDetections(const ScanReport& report);

// A line for each stage, one column of times (ms), the sum of each process in a line of its own.
// Empty when there are no times. A stage named "total" counts as the sum.
std::string FormatStageTimes(const std::vector<ProcessTimes>& processes);

}  // namespace rimod
