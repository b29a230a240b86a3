#pragma once

#include <memory>

#include "io/process_options.h"
#include "tuning/tune_command.h"

namespace rimod {

// rimod-tune's command line; its help text explains each option. The app refers to the options,
// which must outlive it.
struct TuneCommandLine {
  CommonOptions common;
  TuneOptions options;
};
std::unique_ptr<CLI::App> MakeTuneApp(TuneCommandLine* command_line);

}  // namespace rimod
