#pragma once

#include <memory>

#include "io/process_options.h"
#include "viewer_tools/report.h"

namespace rimod {

// rimod-report's command line; its help text explains each option. The app refers to the options,
// which must outlive it.
struct ReportCommandLine {
  CommonOptions common;
  BusOptions bus;
  ReportOptions options;
};
std::unique_ptr<CLI::App> MakeReportApp(ReportCommandLine* command_line);

}  // namespace rimod
