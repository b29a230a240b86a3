#include "io/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "io/files.h"
#include "io/mesh_parsers.h"

namespace rimod {
namespace {

constexpr std::int64_t kMaxFileBytes = 256'000'000;

std::string LowerCaseEnding(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

std::string Parse(const std::string& path, const std::string& bytes, RawMesh* mesh) {
  const std::string ending = LowerCaseEnding(path);
  if (bytes.empty()) return "is empty";
  if (ending == ".obj") return ParseObjMesh(bytes, mesh);
  if (ending == ".ply") return ParsePlyMesh(bytes, mesh);
  if (ending == ".stl") return ParseStlMesh(bytes, mesh);
  return "is no mesh by its ending: .obj, .ply and .stl are read";
}

bool HasArea(const RawMesh& mesh, const Eigen::Vector3i& triangle) {
  constexpr double kFarthest = 1e4;        // m: no object is that large
  constexpr double kSmallestArea = 1e-12;  // m^2; normals of smaller ones are noise
  const auto vertex = [&](int corner) {
    return mesh.vertices[static_cast<std::size_t>(triangle[corner])];
  };
  for (int corner = 0; corner < 3; ++corner) {
    if (!vertex(corner).allFinite() || vertex(corner).cwiseAbs().maxCoeff() > kFarthest) {
      return false;
    }
  }
  const Eigen::Vector3d side_a = vertex(1) - vertex(0);
  const Eigen::Vector3d side_b = vertex(2) - vertex(0);
  return 0.5 * side_a.cross(side_b).norm() >= kSmallestArea;
}

// The triangles that can be used and the vertices that they use, both in order.
Mesh CleanedMesh(const RawMesh& raw) {
  constexpr int kUnused = -1;
  Mesh mesh;
  std::vector<int> new_index(raw.vertices.size(), kUnused);
  for (Eigen::Vector3i triangle : raw.triangles) {
    if (!HasArea(raw, triangle)) continue;
    for (int corner = 0; corner < 3; ++corner) {
      const auto old_index = static_cast<std::size_t>(triangle[corner]);
      if (new_index[old_index] == kUnused) {
        new_index[old_index] = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(raw.vertices[old_index]);
      }
      triangle[corner] = new_index[old_index];
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace

bool AppendPolygon(const std::vector<std::int64_t>& corners, std::size_t num_vertices,
                   RawMesh* mesh) {
  const bool valid = std::all_of(corners.begin(), corners.end(), [&](std::int64_t corner) {
    return corner >= 0 && corner < static_cast<std::int64_t>(num_vertices);
  });
  if (!valid) return false;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    mesh->triangles.emplace_back(static_cast<int>(corners[0]), static_cast<int>(corners[i - 1]),
                                 static_cast<int>(corners[i]));
  }
  return true;
}

MeshResult ReadMesh(const std::string& path) {
  MeshResult result;
  const FileBytes file = ReadFile(path, kMaxFileBytes);
  if (!file.bytes) {
    result.error = file.error;
    return result;
  }
  RawMesh raw;
  std::string complaint = Parse(path, *file.bytes, &raw);
  Mesh mesh = CleanedMesh(raw);
  if (complaint.empty() && mesh.triangles.empty()) complaint = "has no triangle with an area";
  if (!complaint.empty()) {
    result.error = path + ": " + complaint;
    return result;
  }
  result.dropped_triangles =
      static_cast<std::int64_t>(raw.triangles.size() - mesh.triangles.size());
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace rimod
