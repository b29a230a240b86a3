#include "io/partial_messages.h"

#include <utility>

#include "io/pose_messages.h"

namespace rimod {
namespace {

template <typename Partial, typename Section>
std::vector<Partial> Wrap(std::int64_t sweep_utime, std::vector<Section> sections) {
  std::vector<Partial> partials;
  for (Section& section : sections) {
    Partial partial = {};
    partial.utime = sweep_utime;
    partial.section = std::move(section);
    partials.push_back(std::move(partial));
  }
  return partials;
}

}  // namespace

std::vector<partial_scan_t> ToPartialSections(const SweepGrowth& growth) {
  const StampedScan scan = {growth.begin.count(), growth.end.count(), growth.num_lines, 0,
                            growth.scan};
  std::vector<partial_scan_t> partials =
      Wrap<partial_scan_t>(growth.sweep_begin.count(), ToSections(scan));
  for (partial_scan_t& partial : partials) partial.step = growth.step;
  return partials;
}

JoinedSweepGrowth SweepGrowthFrom(std::int64_t sweep_utime, int step,
                                  const std::vector<scan_t>& sections) {
  JoinedScan joined = JoinScanSections(sections);
  if (!joined.scan) return {std::nullopt, std::move(joined.error)};
  if (joined.scan->utime < sweep_utime) return {std::nullopt, "grows before its sweep begins"};
  if (step < 0) return {std::nullopt, "has a negative step"};
  SweepGrowth growth;
  growth.sweep_begin = Time(sweep_utime);
  growth.step = step;
  growth.begin = Time(joined.scan->utime);
  growth.end = Time(joined.scan->utime_end);
  growth.num_lines = joined.scan->num_lines;
  growth.scan = std::move(joined.scan->scan);
  return {std::move(growth), ""};
}

scan_end_t ToScanEnd(const Sweep& sweep) {
  scan_end_t message = {};
  message.utime = sweep.begin.count();
  message.utime_end = sweep.end.count();
  message.num_steps = sweep.rest->step + (sweep.rest->num_lines > 0 ? 1 : 0);
  message.num_lines = sweep.num_lines;
  message.num_missing_lines = sweep.num_missing_lines;
  message.num_points = static_cast<std::int32_t>(sweep.scan.points.size());
  message.num_no_returns = static_cast<std::int32_t>(sweep.scan.no_return_directions.size());
  SetPosition(sweep.scan.T_local_sensor.translation(), message.sensor_position);
  SetOrientation(LevelQuaternionOf(sweep.scan.T_local_sensor), message.sensor_orientation);
  return message;
}

SweepEndFromMessage FromMessage(const scan_end_t& message) {
  const std::optional<Eigen::Isometry3d> T_local_sensor =
      LevelPoseFrom(message.sensor_position, message.sensor_orientation);
  if (!T_local_sensor) return {std::nullopt, "sensor pose is not a pose"};
  if (message.utime_end < message.utime) return {std::nullopt, "scan ends before it begins"};
  if (message.num_steps < 1) return {std::nullopt, "a sweep of no steps"};
  if (message.num_lines < 0 || message.num_missing_lines < 0 || message.num_points < 0 ||
      message.num_no_returns < 0) {
    return {std::nullopt, "negative number of lines or points"};
  }
  SweepEnd end;
  end.begin = Time(message.utime);
  end.end = Time(message.utime_end);
  end.num_steps = message.num_steps;
  end.num_lines = message.num_lines;
  end.num_missing_lines = message.num_missing_lines;
  end.num_points = static_cast<std::size_t>(message.num_points);
  end.num_no_returns = static_cast<std::size_t>(message.num_no_returns);
  end.T_local_sensor = *T_local_sensor;
  return {end, ""};
}

std::vector<partial_range_image_t> ToPartialSections(const RangeImage& image,
                                                     std::int64_t sweep_utime,
                                                     std::int64_t known_until) {
  return Wrap<partial_range_image_t>(sweep_utime, ToSections(image, known_until));
}

std::vector<partial_feature_set_t> ToPartialSections(const FeatureSet& features,
                                                     std::int64_t sweep_utime,
                                                     std::int64_t known_until) {
  return Wrap<partial_feature_set_t>(sweep_utime, ToSections(features, known_until));
}

}  // namespace rimod
