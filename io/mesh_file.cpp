#include "io/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cctype>
#include <exception>
#include <filesystem>

#include "io/files.h"
#include "io/ply_header.h"

namespace rimod {
namespace {

constexpr std::int64_t kMaxFileBytes = 1'000'000'000;
constexpr double kFarthest = 1e4;  // m: no object is that large

constexpr unsigned int kSteps = aiProcess_Triangulate | aiProcess_PreTransformVertices |
                                aiProcess_SortByPType | aiProcess_JoinIdenticalVertices;

bool IsUsable(const Eigen::Vector3d& vertex) {
  return vertex.allFinite() && vertex.cwiseAbs().maxCoeff() <= kFarthest;
}

// Appends the part's usable triangles; returns how many were not.
std::int64_t AppendPart(const aiMesh& part, Mesh* mesh) {
  const std::size_t first = mesh->vertices.size();
  for (unsigned int i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    mesh->vertices.emplace_back(v.x, v.y, v.z);
  }
  std::int64_t num_dropped = 0;
  for (unsigned int i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices < 3) continue;  // points and lines have no surface
    Eigen::Vector3i triangle = Eigen::Vector3i::Zero();
    bool usable = face.mNumIndices == 3;
    for (int corner = 0; usable && corner < 3; ++corner) {
      const unsigned int index = face.mIndices[corner];
      usable = index < part.mNumVertices && IsUsable(mesh->vertices[first + index]);
      triangle[corner] = static_cast<int>(first + index);
    }
    if (usable) {
      const auto vertex = [&](int corner) {
        return mesh->vertices[static_cast<std::size_t>(triangle[corner])];
      };
      const Eigen::Vector3d side_a = vertex(1) - vertex(0);
      const Eigen::Vector3d side_b = vertex(2) - vertex(0);
      constexpr double kSmallestArea = 1e-12;  // m^2; normals of smaller ones are noise
      usable = 0.5 * side_a.cross(side_b).norm() >= kSmallestArea;
    }
    if (usable) {
      mesh->triangles.push_back(triangle);
    } else {
      ++num_dropped;
    }
  }
  return num_dropped;
}

// Vertices that no triangle uses may be anything: the usable ones stay in order, the others go.
void DropUnusedVertices(Mesh* mesh) {
  constexpr int kUnused = -1;
  std::vector<int> new_index(mesh->vertices.size(), kUnused);
  std::vector<Eigen::Vector3d> used;
  for (Eigen::Vector3i& triangle : mesh->triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      int& index = new_index[static_cast<std::size_t>(triangle[corner])];
      if (index == kUnused) {
        index = static_cast<int>(used.size());
        used.push_back(mesh->vertices[static_cast<std::size_t>(triangle[corner])]);
      }
      triangle[corner] = index;
    }
  }
  mesh->vertices = std::move(used);
}

std::string LowerCaseEnding(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

// What Assimp would believe and allocate for: a PLY header with more elements than bytes follow.
std::string CheckPly(const std::string& bytes) {
  PlyHeader header;
  const std::string error = ParsePlyHeader(bytes, &header);
  if (!error.empty()) return error;
  std::int64_t num_numbers = 0;  // at the least
  for (const PlyElement& element : header.elements) {
    const auto room = static_cast<std::int64_t>(bytes.size()) - num_numbers;
    if (element.count > room) return "is truncated: declares more elements than it holds";
    num_numbers += element.count * static_cast<std::int64_t>(element.properties.size());
  }
  const bool fits = num_numbers <= static_cast<std::int64_t>(bytes.size() - header.data_begin);
  return fits ? "" : "is truncated: declares more elements than it holds";
}

MeshResult Bad(const std::string& path, const std::string& cause) {
  MeshResult result;
  result.error = path + ": " + cause;
  return result;
}

}  // namespace

MeshResult ReadMesh(const std::string& path) {
  const FileBytes file = ReadFile(path, kMaxFileBytes);
  if (!file.bytes) {
    MeshResult result;
    result.error = file.error;
    return result;
  }
  if (file.bytes->empty()) return Bad(path, "is empty");
  const std::string ending = LowerCaseEnding(path);
  if (ending != ".obj" && ending != ".ply" && ending != ".stl") {
    return Bad(path, "is no mesh by its ending: .obj, .ply and .stl are read");
  }
  const std::string complaint = ending == ".ply" ? CheckPly(*file.bytes) : "";
  if (!complaint.empty()) return Bad(path, complaint);
  MeshResult result;
  result.mesh.emplace();
  try {
    Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile(path, kSteps);
    if (!scene) return Bad(path, "is not a mesh: " + std::string(importer.GetErrorString()));
    for (unsigned int i = 0; i < scene->mNumMeshes; ++i) {
      result.dropped_triangles += AppendPart(*scene->mMeshes[i], &*result.mesh);
    }
  } catch (const std::exception& exception) {
    return Bad(path, "is not a mesh: " + std::string(exception.what()));
  }
  if (result.mesh->triangles.empty()) return Bad(path, "has no triangle with an area");
  DropUnusedVertices(&*result.mesh);
  return result;
}

}  // namespace rimod
