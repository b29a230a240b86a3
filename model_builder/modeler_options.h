#pragma once

#include <memory>

#include "model_builder/modeler_command.h"

namespace rimod {

// rimod-modeler's command line; its help text explains each option. The app refers to the options,
// which must outlive it.
struct ModelerCommandLine {
  CommonOptions common;
  ModelerOptions options;
};
std::unique_ptr<CLI::App> MakeModelerApp(ModelerCommandLine* command_line);

}  // namespace rimod
