#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scanner_proc/scene.h"
#include "scanner_proc/yaml_section.h"

namespace rimod::simulation {

// Reads objects of scene files, with the shapes and meshes that they use. Methods throw YamlError.
class SceneObjectReader {
 public:
  // Named shapes for objects to use; a name that is known already is an error.
  void ReadShapes(YamlSection shapes);
  // The list of objects under the key; empty where there is none.
  std::vector<SceneObject> ReadObjects(YamlSection* section, const std::string& key);

 private:
  SceneObject ReadObject(YamlSection section);
  // class, symmetry, reflectivity and the parts.
  void ReadLooks(YamlSection* section, SceneObject* object);
  std::vector<Part> ReadParts(YamlSection* section, double reflectivity);
  Part ReadPart(YamlSection section, double reflectivity);
  Shape ReadShape(YamlSection* section);
  MeshShape ReadMeshShape(YamlSection section);
  // The section's only key of those that tell a shape.
  std::string ShapeKey(const YamlSection& section) const;
  void CountParts(const YamlSection& section, std::size_t number);

  std::map<std::string, SceneObject> shapes_;                  // by name, at the origin
  std::map<std::string, std::shared_ptr<const Mesh>> meshes_;  // by path, as in their files
  std::size_t num_parts_ = 0;
  std::size_t num_triangles_ = 0;
};

}  // namespace rimod::simulation
