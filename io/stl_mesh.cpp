#include <array>
#include <map>
#include <optional>

#include "io/mesh_parsers.h"
#include "io/numbers.h"

namespace rimod {
namespace {

constexpr std::size_t kHeaderBytes = 84;    // text, then the number of triangles
constexpr std::size_t kTriangleBytes = 50;  // normal, three corners, two bytes of anything

// STL repeats a vertex for each of its triangles: equal ones become one.
class VertexJoiner {
 public:
  explicit VertexJoiner(RawMesh* mesh) : mesh_(mesh) {}

  std::int64_t Add(const Eigen::Vector3d& vertex) {
    const std::array<double, 3> key = {vertex.x(), vertex.y(), vertex.z()};
    const auto next = static_cast<std::int64_t>(mesh_->vertices.size());
    if (!vertex.allFinite()) {  // not comparable
      mesh_->vertices.push_back(vertex);
      return next;
    }
    const auto [place, is_new] = indices_.emplace(key, next);
    if (is_new) mesh_->vertices.push_back(vertex);
    return place->second;
  }

 private:
  RawMesh* mesh_;
  std::map<std::array<double, 3>, std::int64_t> indices_;
};

std::size_t DeclaredBytes(std::string_view bytes) {
  const NumberFormat format{NumberFormat::Kind::kUnsigned, 4};
  const double count = ReadNumber(bytes.data() + kHeaderBytes - 4, format, ByteOrder::kLittle);
  return kHeaderBytes + kTriangleBytes * static_cast<std::size_t>(count);
}

std::string ParseBinary(std::string_view bytes, RawMesh* mesh) {
  const NumberFormat format{NumberFormat::Kind::kFloat, 4};
  VertexJoiner joiner(mesh);
  for (std::size_t at = kHeaderBytes; at < bytes.size(); at += kTriangleBytes) {
    std::vector<std::int64_t> corners;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Eigen::Vector3d vertex = Eigen::Vector3d::Zero();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t offset = at + 4 * (3 + 3 * corner + axis);  // after the normal
        vertex[static_cast<Eigen::Index>(axis)] =
            ReadNumber(bytes.data() + offset, format, ByteOrder::kLittle);
      }
      corners.push_back(joiner.Add(vertex));
    }
    AppendPolygon(corners, mesh->vertices.size(), mesh);
  }
  return "";
}

std::string ParseText(std::string_view text, RawMesh* mesh) {
  TextCursor cursor(text);
  VertexJoiner joiner(mesh);
  std::vector<std::int64_t> corners;
  while (const std::optional<std::string_view> line = cursor.NextLine()) {
    const std::vector<std::string_view> words = SplitWords(*line);
    if (words.empty()) continue;
    const std::string place = " in line " + std::to_string(cursor.line_number());
    if (words[0] == "vertex") {
      Eigen::Vector3d vertex = Eigen::Vector3d::Zero();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::optional<double> number =
            axis + 1 < words.size() ? ParseNumber(words[axis + 1]) : std::nullopt;
        if (!number) return "has a bad vertex" + place;
        vertex[static_cast<Eigen::Index>(axis)] = *number;
      }
      corners.push_back(joiner.Add(vertex));
    } else if (words[0] == "endfacet") {
      if (corners.size() != 3) return "has a facet without three vertices" + place;
      AppendPolygon(corners, mesh->vertices.size(), mesh);
      corners.clear();
    }
  }
  return corners.empty() ? "" : "is truncated: its last facet has no end";
}

}  // namespace

std::string ParseStlMesh(std::string_view bytes, RawMesh* mesh) {
  // Binary files too may begin with "solid": the length tells.
  const bool has_count = bytes.size() >= kHeaderBytes;
  if (has_count && DeclaredBytes(bytes) == bytes.size()) return ParseBinary(bytes, mesh);
  if (bytes.substr(0, 5) == "solid") return ParseText(bytes, mesh);
  if (!has_count || DeclaredBytes(bytes) > bytes.size()) {
    return "is truncated: declares more triangles than it holds, or no STL";
  }
  return ParseBinary(bytes.substr(0, DeclaredBytes(bytes)), mesh);
}

}  // namespace rimod
