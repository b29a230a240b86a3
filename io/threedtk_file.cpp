#include "io/numbers.h"
#include "io/point_cloud_parsers.h"

namespace rimod {
namespace {

constexpr double kMetresPerUnit = 0.01;  // the format's unit is the centimetre
// m; a beam without a return reads as the largest number of the scanners, 32767 mm.
constexpr double kNoReturnFrom = 32.75;
constexpr double kNoReturnTo = 32.78;
constexpr double kNearRange = 0.2;  // m; what is nearer belongs to the scanner's carrier

// Of a line that begins with three numbers: the point in the sensor frame, m.
std::optional<Eigen::Vector3d> ParsePoint(std::string_view line) {
  TextCursor words(line);
  double values[3] = {0.0, 0.0, 0.0};
  for (double& value : values) {
    const std::optional<std::string_view> word = words.NextWord();
    const std::optional<double> number = word ? ParseNumber(*word) : std::nullopt;
    if (!number) return std::nullopt;
    value = *number * kMetresPerUnit;
  }
  return Eigen::Vector3d(values[2], -values[0], values[1]);  // right, up, forward -> ours
}

void AddReading(const Eigen::Vector3d& p_sensor, PointCloudResult* result) {
  const double range = p_sensor.norm();
  if (range >= kNoReturnFrom && range <= kNoReturnTo) {
    ++result->counts.no_return;
    result->scan->no_return_directions.push_back((p_sensor / range).cast<float>());
  } else if (range < kNearRange) {
    ++result->counts.near;
  } else {
    AddPoint(p_sensor.x(), p_sensor.y(), p_sensor.z(), result);
  }
}

}  // namespace

PointCloudResult Parse3dtk(const std::string& bytes, const std::string& path) {
  PointCloudResult result;
  result.scan.emplace();
  TextCursor cursor(bytes);
  while (const std::optional<std::string_view> line = cursor.NextLine()) {
    const std::optional<Eigen::Vector3d> p_sensor = ParsePoint(*line);
    if (p_sensor) {
      ++result.counts.declared;
      AddReading(*p_sensor, &result);
    } else if (cursor.line_number() > 1 && !SplitWords(*line).empty()) {
      const bool last = cursor.position() >= bytes.size() && bytes.back() != '\n';
      return BadPointCloud(path, (last ? "is truncated in line " : "has no point in line ") +
                                     std::to_string(cursor.line_number()));
    }
  }
  FinishPointCloud(path, &result);
  return result;
}

}  // namespace rimod
