#include "launcher/run_file.h"

#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "io/files.h"

namespace rimod {
namespace {

constexpr std::int64_t kMaxFileBytes = 1'000'000;
constexpr std::size_t kMaxProcesses = 256;
constexpr double kLongest = 3600.0;  // s

// Parsing functions throw what is wrong, without the file's name.
using Problem = std::runtime_error;

void RefuseUnknownKeys(const YAML::Node& map, const std::vector<std::string>& known,
                       const std::string& where) {
  if (!map.IsMap()) throw Problem(where + "is not a list of keys and values");
  for (const auto& item : map) {
    const auto key = item.first.as<std::string>();
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw Problem(where + "unknown key '" + key + "'");
  }
}

void ReadSeconds(const YAML::Node& file, const std::string& key, double smallest, double* value) {
  if (!file[key]) return;
  try {
    *value = file[key].as<double>();
  } catch (const YAML::Exception&) {
    throw Problem("'" + key + "' is not a number of seconds");
  }
  if (!(*value >= smallest && *value <= kLongest)) {
    std::ostringstream text;
    text << "'" << key << "' is " << *value << ", not " << smallest << " .. " << kLongest << " s";
    throw Problem(text.str());
  }
}

bool IsExecutable(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
}

std::string FindExecutable(const std::string& name) {
  if (name.find('/') != std::string::npos) {
    if (!IsExecutable(name)) throw Problem("'" + name + "' is not an executable file");
    return name;
  }
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  std::vector<std::filesystem::path> folders;
  if (!error) folders.push_back(self.parent_path());
  const char* const path = std::getenv("PATH");
  std::istringstream entries(path == nullptr ? "/usr/local/bin:/usr/bin:/bin" : path);
  for (std::string entry; std::getline(entries, entry, ':');)
    if (!entry.empty()) folders.emplace_back(entry);
  for (const std::filesystem::path& folder : folders)
    if (IsExecutable(folder / name)) return folder / name;
  throw Problem("'" + name + "' was found neither beside rimod-run nor in PATH");
}

Restart RestartFrom(const std::string& text) {
  if (text == "always") return Restart::kAlways;
  if (text == "on_failure") return Restart::kOnFailure;
  if (text == "never") return Restart::kNever;
  throw Problem("'restart' is '" + text + "', not always, on_failure or never");
}

RunProcess ProcessFrom(const YAML::Node& node) {
  RefuseUnknownKeys(node, {"name", "command", "restart"}, "a process: ");
  RunProcess process;
  if (!node["name"] || !node["name"].IsScalar() || node["name"].Scalar().empty())
    throw Problem("a process has no 'name'");
  process.name = node["name"].Scalar();
  const YAML::Node command = node["command"];
  if (!command || !command.IsSequence() || command.size() == 0)
    throw Problem(process.name + ": 'command' is not a list of words");
  for (const YAML::Node& word : command) {
    if (!word.IsScalar()) throw Problem(process.name + ": 'command' is not a list of words");
    process.command.push_back(word.Scalar());
  }
  try {
    process.command[0] = FindExecutable(process.command[0]);
    if (node["restart"]) process.restart = RestartFrom(node["restart"].as<std::string>());
  } catch (const Problem& problem) {
    throw Problem(process.name + ": " + problem.what());
  }
  return process;
}

RunFile RunFileFrom(const YAML::Node& file) {
  RefuseUnknownKeys(
      file, {"processes", "stop_patience", "first_pause", "longest_pause", "steady_time"}, "");
  RunFile run_file;
  constexpr double kShortest = 0.01;
  ReadSeconds(file, "stop_patience", 0.0, &run_file.stop_patience);
  ReadSeconds(file, "first_pause", kShortest, &run_file.first_pause);
  ReadSeconds(file, "longest_pause", kShortest, &run_file.longest_pause);
  ReadSeconds(file, "steady_time", kShortest, &run_file.steady_time);
  if (run_file.longest_pause < run_file.first_pause)
    throw Problem("'longest_pause' is shorter than 'first_pause'");
  const YAML::Node processes = file["processes"];
  if (!processes || !processes.IsSequence() || processes.size() == 0)
    throw Problem("'processes' is not a list");
  if (processes.size() > kMaxProcesses) throw Problem("too many processes");
  for (const YAML::Node& node : processes) {
    RunProcess process = ProcessFrom(node);
    for (const RunProcess& other : run_file.processes)
      if (other.name == process.name) throw Problem("two processes named '" + process.name + "'");
    run_file.processes.push_back(std::move(process));
  }
  return run_file;
}

}  // namespace

RunFileResult ReadRunFile(const std::string& path) {
  const FileBytes file = ReadFile(path, kMaxFileBytes);
  if (!file.bytes) return {std::nullopt, file.error};
  try {
    return {RunFileFrom(YAML::Load(*file.bytes)), ""};
  } catch (const std::exception& problem) {
    return {std::nullopt, path + ": " + problem.what()};
  }
}

double NextPause(const RunFile& run_file, double last_pause, double lived) {
  if (last_pause <= 0.0 || lived >= run_file.steady_time) return run_file.first_pause;
  return std::min(2.0 * last_pause, run_file.longest_pause);
}

}  // namespace rimod
