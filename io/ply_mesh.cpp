#include <array>
#include <cmath>

#include "io/mesh_parsers.h"
#include "io/ply_numbers.h"

namespace rimod {
namespace {

constexpr std::int64_t kNotAnIndex = -1;

bool IsFaceList(const PlyProperty& property) {
  return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

// Reads one record: the vertex and the face's corners that it holds, if any. False when the data
// end or are damaged.
bool ReadRecord(const PlyElement& element, PlyNumbers* numbers, Eigen::Vector3d* vertex,
                std::vector<double>* corners) {
  for (const PlyProperty& property : element.properties) {
    if (property.is_list) {
      if (!numbers->NextList(property, IsFaceList(property) ? corners : nullptr)) return false;
      continue;
    }
    const std::optional<double> value = numbers->Next(property.format);
    if (!value) return false;
    const std::size_t axis = std::string_view("xyz").find(property.name);
    const bool is_coordinate = property.name.size() == 1 && axis < 3;
    if (is_coordinate) (*vertex)[static_cast<Eigen::Index>(axis)] = *value;
  }
  return true;
}

std::vector<std::int64_t> IndicesFrom(const std::vector<double>& numbers) {
  constexpr double kLargest = 4294967295.0;
  std::vector<std::int64_t> indices;
  for (const double number : numbers) {
    const bool valid = number >= 0.0 && number <= kLargest && number == std::floor(number);
    indices.push_back(valid ? static_cast<std::int64_t>(number) : kNotAnIndex);
  }
  return indices;
}

}  // namespace

std::string ParsePlyMesh(const std::string& bytes, RawMesh* mesh) {
  if (bytes.rfind("ply", 0) != 0) return "is no PLY file";
  PlyHeader header;
  const std::string error = ParsePlyHeader(bytes, &header);
  if (!error.empty()) return error;
  PlyNumbers numbers(header.encoding, std::string_view(bytes).substr(header.data_begin));
  std::vector<std::vector<std::int64_t>> faces;
  for (const PlyElement& element : header.elements) {
    if (element.properties.empty()) continue;  // takes no bytes, whatever its count
    for (std::int64_t i = 0; i < element.count; ++i) {
      Eigen::Vector3d vertex = Eigen::Vector3d::Zero();
      std::vector<double> corners;
      if (!ReadRecord(element, &numbers, &vertex, &corners)) {
        return "is truncated or damaged: number " + std::to_string(i) + " of " +
               std::to_string(element.count) + " of '" + element.name.substr(0, 40) +
               "' cannot be read";
      }
      if (element.name == "vertex") mesh->vertices.push_back(vertex);
      if (element.name == "face") faces.push_back(IndicesFrom(corners));
    }
  }
  for (const std::vector<std::int64_t>& face : faces) {
    if (!AppendPolygon(face, mesh->vertices.size(), mesh)) {
      return "has a face with a vertex that is not there";
    }
  }
  return "";
}

}  // namespace rimod
