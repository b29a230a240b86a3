#pragma once

#include <optional>

#include "viewer_tools/view_command.h"

namespace rimod {

struct ViewOptionsResult {
  std::optional<ViewOptions> options;
  int exit_code = 0;  // where there are none: 0 after --help, 2 for bad usage (told on stderr)
};
ViewOptionsResult ParseViewOptions(int argc, char** argv);

}  // namespace rimod
