// Scenes of the simulator. Meshes and scenes that an input names are looked for in its folder only
// by chance: they are not there.

#include "scanner_proc/scene_file.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const rimod::InputFile file("scene.yaml");
  const auto result = rimod::simulation::ReadScene(file.Write(bytes, size));
  rimod::Require(result.scene.has_value() == result.error.empty(), "a scene or an error");
  return 0;
}
