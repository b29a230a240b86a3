#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rimod {

// Whether a process that ends by itself is started anew.
enum class Restart { kAlways, kOnFailure, kNever };

// One process of a run file.
struct RunProcess {
  std::string name;                  // for messages, unique in the file
  std::vector<std::string> command;  // executable and arguments
  Restart restart = Restart::kAlways;
};

// Which processes run together, and how they are restarted and stopped.
struct RunFile {
  std::vector<RunProcess> processes;  // in the order in which they start; at least one
  double stop_patience = 5.0;         // s, from SIGTERM until what still runs is killed; 0 .. 3600
  double first_pause = 0.5;     // s, before a restart; > 0, doubled each time up to longest_pause
  double longest_pause = 30.0;  // s; >= first_pause, at most 3600
  double steady_time = 10.0;    // s; what lived so long starts with the first pause again; > 0
};

// A run file, or why there is none.
struct RunFileResult {
  std::optional<RunFile> run_file;
  std::string error;  // names the file, the key and the cause
};

// Reads YAML; docs/running.md has the keys. Unknown keys, repeated names and values out of range
// are errors. Executables without a slash are looked for beside this program, then in PATH; the
// first word of each command is the path found. One that is not found is an error.
RunFileResult ReadRunFile(const std::string& path);

// The pause before the next restart of a process, s. last_pause: before the last one, 0 for none;
// lived: s, how long it ran. Doubles, unless it lived for steady_time.
double NextPause(const RunFile& run_file, double last_pause, double lived);

}  // namespace rimod
