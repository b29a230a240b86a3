#include "model_builder/inspect_command.h"

#include <spdlog/spdlog.h>

#include <iostream>

#include "io/files.h"
#include "io/model_file.h"
#include "viewer_tools/model_sheet.h"
#include "viewer_tools/png.h"

namespace rimod {

int RunInspect(const std::string& model_path, const std::string& output,
               const Configuration& configuration) {
  constexpr int kDone = 0;
  constexpr int kFailed = 1;
  const ModelFileResult read = ReadModelFile(model_path);
  if (!read.model) {
    spdlog::error("{}", read.error);
    return kFailed;
  }
  const std::string png =
      EncodePng(DrawModelSheet(*read.model, configuration.pipeline.range_image.resolution));
  const std::string error =
      png.empty() ? output + ": the picture cannot be encoded" : WriteFileAtomically(output, png);
  if (!error.empty()) {
    spdlog::error("{}", error);
    return kFailed;
  }
  std::cout << output << '\n';
  return kDone;
}

}  // namespace rimod
