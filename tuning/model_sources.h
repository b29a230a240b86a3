#pragma once

#include <string>
#include <vector>

#include "rimod/execution.h"
#include "rimod/hit_counting.h"
#include "rimod/object_model.h"
#include "rimod/params.h"
#include "rimod/recording.h"

namespace rimod {

// What the models that are looked for are made of: recordings, else finished models.
struct ModelSources {
  std::vector<Recording> recordings;
  std::vector<ObjectModel> models;  // used where there are no recordings
  ObjectShapes shapes;              // of all, by class
  std::vector<std::string> warnings;
  std::string error;  // names the file; not empty: nothing to look for
};

// recordings: a folder of folders with model.json and scan_*.pcd each, also in a folder `models` in
// it; models: a folder of *.rimod, used when recordings is empty. Anything that cannot be used is
// an error.
ModelSources ReadModelSources(const std::string& recordings, const std::string& models,
                              const Execution& execution);

// The models with these parameters; throws as BuildModel. Views are computed.
std::vector<ObjectModel> BuildModels(const ModelSources& sources, const PipelineParams& params,
                                     const Execution& execution);

}  // namespace rimod
