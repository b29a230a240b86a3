#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rimod/execution.h"
#include "rimod/object_model.h"

namespace rimod {

// A model read from its file, or why there is none.
struct ModelFileResult {
  std::optional<ObjectModel> model;
  std::string error;  // names the file and the cause; empty when there is a model
};

// A `.rimod` file: the line "rimod-model\n", then big-endian: int32 format version, int32 number of
// sections, per section int32 length and that many bytes of lcm-encoded rimod.object_model_t, and
// last the CRC-32 (zlib's) of all bytes before it.
constexpr int kModelFileVersion = 1;

// The bytes of a model file; equal models give equal bytes.
std::string EncodeModelFile(const ObjectModel& model);

// name stands for the file in error texts.
ModelFileResult DecodeModelFile(const std::string& bytes, const std::string& name);

ModelFileResult ReadModelFile(const std::string& path);

// Returns an error text, empty when done; never leaves half a file. An invalid model is such an
// error.
std::string WriteModelFile(const std::string& path, const ObjectModel& model);

struct ModelFolder {
  std::vector<ObjectModel> models;
  std::vector<std::string> bad_files;  // an error text each: left out
  std::string error;                   // the folder itself could not be read; names it
};

// Every *.rimod in the folder, sorted by file name. Of two models with one name the second is bad.
ModelFolder LoadModelFolder(const std::string& folder, const Execution& execution = {});

}  // namespace rimod
