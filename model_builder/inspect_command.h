#pragma once

#include <string>

#include "io/config.h"

namespace rimod {

// Draws the contact sheet of a model file and prints its path on stdout. Returns the exit code: 0,
// or 1 when the model could not be read or the picture not written.
int RunInspect(const std::string& model_path, const std::string& output,
               const Configuration& configuration);

}  // namespace rimod
