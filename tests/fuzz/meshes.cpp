// OBJ, PLY and STL files; the input's first byte chooses the ending.

#include "io/mesh_file.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const rimod::InputFile obj("mesh.obj"), ply("mesh.ply"), stl("mesh.stl");
  if (size == 0) return 0;
  const rimod::InputFile& file = bytes[0] % 3 == 0 ? obj : bytes[0] % 3 == 1 ? ply : stl;
  const rimod::MeshResult result = rimod::ReadMesh(file.Write(bytes + 1, size - 1));
  rimod::Require(result.mesh.has_value() == result.error.empty(), "a mesh or an error");
  if (!result.mesh) return 0;
  const auto num_vertices = static_cast<int>(result.mesh->vertices.size());
  rimod::Require(!result.mesh->triangles.empty(), "a mesh has triangles");
  for (const Eigen::Vector3i& triangle : result.mesh->triangles)
    rimod::Require(triangle.minCoeff() >= 0 && triangle.maxCoeff() < num_vertices, "indices");
  for (const auto& vertex : result.mesh->vertices)
    rimod::Require(vertex.allFinite(), "vertices are finite");
  return 0;
}
