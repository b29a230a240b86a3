#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "rimod/model_building.h"

namespace rimod {

// A mesh read from a file, or why there is none.
struct MeshResult {
  std::optional<Mesh> mesh;
  std::string error;                   // names the file and the cause; empty when there is a mesh
  std::int64_t dropped_triangles = 0;  // left out: no area, or a corner that is not finite
};

// Reads .stl (text or binary), .obj or .ply, told by the ending; all parts joined, polygons cut
// into triangles, units taken as metres. Every triangle of the result has an area and finite
// corners; there is at least one, and no vertex is unused. Indices of vertices that are not there
// are an error.
MeshResult ReadMesh(const std::string& path);

}  // namespace rimod
