#pragma once

#include "rimod/range_image.h"
#include "rimod/sweep_assembler.h"

namespace rimod {

enum class Method {
  kPaper,    // as literal as it works
  kDefault,  // the best that we know
};

// Everything that can be set, one struct a stage. io/config reads it from YAML.
struct PipelineParams {
  Method method = Method::kDefault;
  SweepParams sweep;
  RangeImageParams range_image;
};

}  // namespace rimod
