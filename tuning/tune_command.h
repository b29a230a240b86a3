#pragma once

#include <atomic>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "io/channels.h"
#include "io/config.h"

namespace rimod {

// What rimod-tune was asked to do.
struct TuneOptions {
  std::string recordings;         // folder of recordings; one of these two is given
  std::string models;             // folder with *.rimod
  std::string labels;             // what stands in the scans
  std::vector<std::string> vary;  // parameters; empty: DefaultVaryTexts
  std::string objective = "f1";
  double max_ms = 0.0;    // processor time a scan; 0: any
  double budget = 600.0;  // s, for all searches; not used with num_trials
  int num_trials = 0;     // settings a search; 0: as many as the budget allows
  int num_folds = 3;      // 2 .. 20
  int num_threads = 0;    // 0: as many as the machine has
  std::uint64_t seed = 1;
  bool even_if_unclear = false;    // write what was found although it may be chance
  bool list = false;               // print the parameters, do nothing else
  std::string out;                 // configuration file; empty: none
  std::string csv;                 // table of all trials; empty: none
  CloudChannels clouds;            // of point clouds in logs
  std::vector<std::string> scans;  // logs, files
};

// Seconds of "90s", "20min", "1.5h"; nothing for anything else or beyond 30 days.
std::optional<double> SecondsFrom(const std::string& text);

// Looks for better parameters, prints what they are worth on `out` and writes them; messages go to
// the log. After stop was set it writes the best so far. Returns the exit code: 0 done, 1 an input
// could not be read or used or an output not written, 2 bad usage (parameter, range, objective).
int RunTune(const TuneOptions& options, const Configuration& configuration,
            const std::atomic<bool>& stop, std::ostream& out);

}  // namespace rimod
