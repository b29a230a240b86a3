#pragma once

#include <optional>
#include <string>

#include "scanner_proc/scene.h"

namespace rimod::simulation {

struct SceneResult {
  std::optional<Scene> scene;
  std::string error;  // names file, line, key and cause; empty when there is a scene
};

// Reads a scene (YAML; docs/simulator.md has every key). Files that it names (meshes, includes) are
// found relative to it. Unknown keys and values out of range are errors.
SceneResult ReadScene(const std::string& path);

}  // namespace rimod::simulation
