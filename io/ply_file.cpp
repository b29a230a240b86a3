#include <algorithm>
#include <array>

#include "io/ply_numbers.h"
#include "io/point_cloud_parsers.h"

namespace rimod {
namespace {

// Where the three wanted properties stand in an element; nothing when one is missing.
std::optional<std::array<std::size_t, 3>> FindProperties(const PlyElement& element,
                                                         const std::array<const char*, 3>& names) {
  std::array<std::size_t, 3> columns{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto property =
        std::find_if(element.properties.begin(), element.properties.end(),
                     [&](const PlyProperty& p) { return p.name == names[axis] && !p.is_list; });
    if (property == element.properties.end()) return std::nullopt;
    columns[axis] = static_cast<std::size_t>(property - element.properties.begin());
  }
  return columns;
}

// Reads one record of an element; xyz are the wanted columns. False when the data end or are
// damaged.
bool ReadRecord(const PlyElement& element, const std::array<std::size_t, 3>& columns,
                PlyNumbers* numbers, double xyz[3]) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (property.is_list) {
      if (!numbers->NextList(property, nullptr)) return false;
      continue;
    }
    const std::optional<double> value = numbers->Next(property.format);
    if (!value) return false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (columns[axis] == i) xyz[axis] = *value;
    }
  }
  return true;
}

// Reads an element's records: vertices become points, a camera the sensor's position, others are
// passed over. Returns an error text.
std::string ReadElement(const PlyElement& element, PlyNumbers* numbers, PointCloudResult* result) {
  if (element.properties.empty()) return "";  // takes no bytes, whatever its count
  const bool is_vertex = element.name == "vertex";
  const bool is_camera = element.name == "camera";
  const std::optional<std::array<std::size_t, 3>> found =
      is_vertex ? FindProperties(element, {"x", "y", "z"})
                : FindProperties(element, {"view_px", "view_py", "view_pz"});
  if (is_vertex && !found) return "has vertices without x, y, z";
  const std::array<std::size_t, 3> columns = found.value_or(std::array<std::size_t, 3>{});
  for (std::int64_t i = 0; i < element.count; ++i) {
    double xyz[3] = {0.0, 0.0, 0.0};
    if (!ReadRecord(element, columns, numbers, xyz)) {
      return "is truncated or damaged: declares " + std::to_string(element.count) + " of '" +
             element.name.substr(0, 40) + "', but number " + std::to_string(i) + " cannot be read";
    }
    if (is_vertex) AddPoint(xyz[0], xyz[1], xyz[2], result);
    if (is_camera && found) {
      const Eigen::Vector3d position(xyz[0], xyz[1], xyz[2]);
      if (!position.allFinite()) return "has a camera at a place that is not finite";
      result->scan->T_local_sensor.translation() = position;
    }
  }
  return "";
}

}  // namespace

PointCloudResult ParsePly(const std::string& bytes, const std::string& path) {
  PlyHeader header;
  std::string error = ParsePlyHeader(bytes, &header);
  if (!error.empty()) return BadPointCloud(path, error);

  PointCloudResult result;
  result.scan.emplace();
  // What comes after the last element that we need is not read.
  std::size_t num_needed = 0;
  for (std::size_t i = 0; i < header.elements.size(); ++i) {
    const PlyElement& element = header.elements[i];
    if (element.name == "vertex" || element.name == "camera") num_needed = i + 1;
    if (element.name == "vertex") result.counts.declared += element.count;
    if (element.name == "vertex" && result.counts.declared > kMaxPoints) {
      return BadPointCloud(path, "declares more than " + std::to_string(kMaxPoints) + " points");
    }
  }
  PlyNumbers numbers(header.encoding, std::string_view(bytes).substr(header.data_begin));
  for (std::size_t i = 0; i < num_needed && error.empty(); ++i) {
    error = ReadElement(header.elements[i], &numbers, &result);
  }
  if (!error.empty()) return BadPointCloud(path, error);
  FinishPointCloud(path, &result);
  return result;
}

}  // namespace rimod
