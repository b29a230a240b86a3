#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace rimod {

// How a process ended.
struct Ending {
  int exit_code = 0;  // where signal is 0
  int signal = 0;     // that killed it
  bool good() const { return exit_code == 0 && signal == 0; }
};
// "with exit code 1", "by signal 9 (Killed)".
std::string Describe(const Ending& ending);

// A process that was started with everything that it starts itself: its process group. All of it is
// killed at the end of this object's life, and asked to end (SIGTERM) when this program dies.
class Child {
 public:
  // command: path and arguments. stdin is empty, stdout and stderr are this program's. Throws
  // std::system_error when the system refuses; a file that turns out to be no executable ends with
  // exit code 127.
  explicit Child(const std::vector<std::string>& command);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t pid() const { return pid_; }
  void Signal(int signal) const;
  // How it ended; nothing while it runs. What is left of its group is killed then.
  std::optional<Ending> Poll();

 private:
  pid_t pid_ = -1;
  std::optional<Ending> ending_;
};

}  // namespace rimod
