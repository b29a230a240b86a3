#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace rimod {

// A program that a test starts: killed at the end of its life, its output kept in files.
class ChildProcess {
 public:
  // words: path and arguments. Its stdout and stderr go to the file output.
  ChildProcess(const std::vector<std::string>& words, std::string output);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void Signal(int signal) const;
  // Waits until it ends. Its exit code, 128 + n when signal n killed it; nothing when it still runs
  // after the timeout.
  std::optional<int> Wait(std::chrono::milliseconds timeout);
  bool running() { return !Wait(std::chrono::milliseconds(0)); }
  pid_t pid() const { return pid_; }
  // What it said so far.
  std::string Output() const;

 private:
  std::string output_;
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

}  // namespace rimod
