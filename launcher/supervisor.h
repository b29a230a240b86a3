#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "launcher/child.h"
#include "launcher/run_file.h"

namespace rimod {

// Runs the processes of a run file: starts them in its order, starts anew what ends, with a pause
// that grows while it keeps ending soon, and stops all.
class Supervisor {
 public:
  explicit Supervisor(RunFile run_file);

  // Runs until stop is set or nothing is left to run, then stops all: SIGTERM to all, SIGKILL to
  // what still runs after stop_patience. Returns the exit code: 0 when every process ended well,
  // 1 when one had to be killed or a last ending was a failure.
  int Run(const std::atomic<bool>& stop);

 private:
  using Clock = std::chrono::steady_clock;
  struct Process {
    RunProcess settings;
    std::unique_ptr<Child> child;  // while it runs
    Clock::time_point started;
    double pause = 0.0;                     // s, the last one; 0: none yet
    std::optional<Clock::time_point> next;  // when it starts; none: it runs or is done
  };

  void Start(Process* process);
  // Looks for what ended and starts what is due.
  void Tend(Process* process);
  void OnEnd(Process* process, const Ending& ending);
  void PlanRestart(Process* process, double lived);
  bool AnythingLeft() const;
  void StopAll();
  bool WaitForAll(Clock::time_point end);

  RunFile run_file_;
  std::vector<Process> processes_;
  bool stopping_ = false;
  bool failed_ = false;
};

}  // namespace rimod
