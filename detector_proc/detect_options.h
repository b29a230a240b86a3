#pragma once

#include <memory>
#include <string>

#include "detector_proc/detect_command.h"
#include "io/process_options.h"

namespace rimod {

// rimod-detect's command line; its help text explains each option. The app refers to the options,
// which must outlive it.
struct DetectCommandLine {
  CommonOptions common;
  DetectOptions options;
};
std::unique_ptr<CLI::App> MakeDetectApp(DetectCommandLine* command_line);

}  // namespace rimod
