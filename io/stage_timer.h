#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "rimod/execution.h"

namespace rimod {

// Wall milliseconds a stage, in the order in which stages first began.
using StageTimes = std::vector<std::pair<std::string, double>>;

// Watches the stages of an execution. Not for several threads at once: stages do not nest.
class StageTimer {
 public:
  // Makes the execution report to this timer, which must outlive it.
  void Watch(Execution* execution);

  // Adds time to a stage from outside.
  void Add(const std::string& stage, double ms);

  // A stage that ran several times has the sum.
  const StageTimes& times() const { return times_; }
  void Reset() { times_.clear(); }

 private:
  StageTimes times_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace rimod
