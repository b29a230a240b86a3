#include "io/scan_messages.h"

#include <algorithm>
#include <cmath>

#include "io/message_codec.h"
#include "io/pose_messages.h"
#include "io/section_header.h"

namespace rimod {
namespace {

constexpr std::size_t kHeaderBytes = 200;  // fixed fields, generously
constexpr std::size_t kEntriesPerSection = (kSectionBytes - kHeaderBytes) / (3 * sizeof(float));

// Entries [begin, end) of a list as three lists of coordinates; returns their number.
std::int32_t SplitCoordinates(const std::vector<Eigen::Vector3f>& list, std::size_t begin,
                              std::size_t end, std::vector<float>* x, std::vector<float>* y,
                              std::vector<float>* z) {
  for (std::size_t i = begin; i < end; ++i) {
    x->push_back(list[i].x());
    y->push_back(list[i].y());
    z->push_back(list[i].z());
  }
  return static_cast<std::int32_t>(x->size());
}

// Appends three lists of coordinates as vectors. False when their lengths are not count.
bool JoinCoordinates(std::int32_t count, const std::vector<float>& x, const std::vector<float>& y,
                     const std::vector<float>& z, std::vector<Eigen::Vector3f>* list) {
  const auto size = static_cast<std::size_t>(count);
  if (count < 0 || x.size() != size || y.size() != size || z.size() != size) return false;
  for (std::size_t i = 0; i < size; ++i) list->emplace_back(x[i], y[i], z[i]);
  return true;
}

bool IsUnit(const Eigen::Vector3f& direction) {
  constexpr float kMaxLengthError = 0.01f;
  return std::abs(direction.norm() - 1.0f) <= kMaxLengthError;
}

std::string CheckSection(const scan_t& section, const scan_t& first, std::size_t index,
                         std::size_t total) {
  if (section.section != static_cast<std::int32_t>(index) ||
      section.num_sections != static_cast<std::int32_t>(total)) {
    return "sections are not in order or not complete";
  }
  if (!SameHeader(section, first)) return "sections are of different scans";
  return "";
}

}  // namespace

std::vector<scan_t> ToSections(const StampedScan& scan) {
  const std::vector<Eigen::Vector3f>& points = scan.scan.points;
  const std::vector<Eigen::Vector3f>& no_returns = scan.scan.no_return_directions;
  const std::size_t num_entries = points.size() + no_returns.size();
  const std::size_t num_sections =
      std::max<std::size_t>(1, (num_entries + kEntriesPerSection - 1) / kEntriesPerSection);

  scan_t header = {};
  header.utime = scan.utime;
  header.utime_end = scan.utime_end;
  header.num_sections = static_cast<std::int32_t>(num_sections);
  header.num_lines = scan.num_lines;
  header.num_missing_lines = scan.num_missing_lines;
  SetPosition(scan.scan.T_local_sensor.translation(), header.sensor_position);
  SetOrientation(LevelQuaternionOf(scan.scan.T_local_sensor), header.sensor_orientation);

  std::vector<scan_t> sections(num_sections, header);
  for (std::size_t i = 0; i < num_sections; ++i) {
    scan_t& section = sections[i];
    section.section = static_cast<std::int32_t>(i);
    // The points, then the beams without a return, are one long list of entries.
    const std::size_t begin = i * kEntriesPerSection;
    const std::size_t end = std::min(begin + kEntriesPerSection, num_entries);
    const std::size_t split = points.size();
    section.num_points = SplitCoordinates(points, std::min(begin, split), std::min(end, split),
                                          &section.x, &section.y, &section.z);
    section.num_no_returns =
        SplitCoordinates(no_returns, std::max(begin, split) - split, std::max(end, split) - split,
                         &section.no_return_x, &section.no_return_y, &section.no_return_z);
  }
  return sections;
}

JoinedScan JoinScanSections(const std::vector<scan_t>& sections) {
  if (sections.empty()) return {std::nullopt, "no sections"};
  const scan_t& first = sections.front();
  const std::optional<Eigen::Isometry3d> T_local_sensor =
      LevelPoseFrom(first.sensor_position, first.sensor_orientation);
  if (!T_local_sensor) return {std::nullopt, "sensor pose is not a pose"};
  if (first.utime_end < first.utime) return {std::nullopt, "scan ends before it begins"};
  if (first.num_lines < 0 || first.num_missing_lines < 0) {
    return {std::nullopt, "negative number of lines"};
  }
  StampedScan scan = {first.utime, first.utime_end, first.num_lines, first.num_missing_lines, {}};
  scan.scan.T_local_sensor = *T_local_sensor;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const scan_t& section = sections[i];
    std::string error = CheckSection(section, first, i, sections.size());
    if (!error.empty()) return {std::nullopt, std::move(error)};
    if (!JoinCoordinates(section.num_points, section.x, section.y, section.z, &scan.scan.points) ||
        !JoinCoordinates(section.num_no_returns, section.no_return_x, section.no_return_y,
                         section.no_return_z, &scan.scan.no_return_directions)) {
      return {std::nullopt, "a count does not fit its list"};
    }
  }
  const auto is_finite = [](const Eigen::Vector3f& point) { return point.allFinite(); };
  if (!std::all_of(scan.scan.points.begin(), scan.scan.points.end(), is_finite)) {
    return {std::nullopt, "a point is not finite"};
  }
  if (!std::all_of(scan.scan.no_return_directions.begin(), scan.scan.no_return_directions.end(),
                   IsUnit)) {
    return {std::nullopt, "a direction without return is not a unit vector"};
  }
  return {std::move(scan), ""};
}

}  // namespace rimod
