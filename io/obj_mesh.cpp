#include <optional>

#include "io/mesh_parsers.h"
#include "io/numbers.h"

namespace rimod {
namespace {

using Words = std::vector<std::string_view>;

// A face, with the line that it stands in.
struct ObjFace {
  std::vector<std::int64_t> corners;  // 0 is the first vertex
  std::int64_t line = 0;
};

bool ParseVertex(const Words& words, RawMesh* mesh) {
  Eigen::Vector3d vertex = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const auto word = static_cast<std::size_t>(axis) + 1;
    const std::optional<double> number =
        word < words.size() ? ParseNumber(words[word]) : std::nullopt;
    if (!number) return false;
    vertex[axis] = *number;
  }
  mesh->vertices.push_back(vertex);
  return true;
}

// Corners are "index", "index/texture" or "index/texture/normal"; the first vertex is 1, the last
// one so far is -1.
bool ParseFace(const Words& words, std::size_t num_vertices, ObjFace* face) {
  for (std::size_t i = 1; i < words.size(); ++i) {
    std::string_view index = words[i].substr(0, words[i].find('/'));
    const bool from_end = !index.empty() && index.front() == '-';
    if (from_end) index.remove_prefix(1);
    const std::optional<std::int64_t> number = ParseCount(index);
    if (!number || *number == 0) return false;
    face->corners.push_back(from_end ? static_cast<std::int64_t>(num_vertices) - *number
                                     : *number - 1);
  }
  return true;
}

}  // namespace

std::string ParseObjMesh(std::string_view bytes, RawMesh* mesh) {
  TextCursor cursor(bytes);
  std::vector<ObjFace> faces;
  while (const std::optional<std::string_view> line = cursor.NextLine()) {
    const Words words = SplitWords(*line);
    bool good = true;
    if (!words.empty() && words[0] == "v") {
      good = ParseVertex(words, mesh);
    } else if (!words.empty() && words[0] == "f") {
      faces.push_back({{}, cursor.line_number()});
      good = ParseFace(words, mesh->vertices.size(), &faces.back());
    }  // all else says nothing about the surface
    if (!good) return "has a bad line " + std::to_string(cursor.line_number());
  }
  for (const ObjFace& face : faces) {  // last, as a face may stand before its vertices
    if (!AppendPolygon(face.corners, mesh->vertices.size(), mesh)) {
      return "has a face with a vertex that is not there in line " + std::to_string(face.line);
    }
  }
  return "";
}

}  // namespace rimod
