#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rimod {

// Vertices and polygons as a file holds them; indices are valid, anything else is unchecked.
struct RawMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;  // polygons cut into fans
};

// Appends the triangles of a polygon with three or more corners; fewer have no surface. False when
// a corner's index (0 is the first vertex) is not one of num_vertices.
bool AppendPolygon(const std::vector<std::int64_t>& corners, std::size_t num_vertices,
                   RawMesh* mesh);

// The readers behind ReadMesh, one a format; bytes are the whole file. Each returns an error text,
// empty when it could be read.
std::string ParseObjMesh(std::string_view bytes, RawMesh* mesh);
std::string ParsePlyMesh(const std::string& bytes, RawMesh* mesh);
std::string ParseStlMesh(std::string_view bytes, RawMesh* mesh);

}  // namespace rimod
