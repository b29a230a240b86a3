#pragma once

#include <atomic>
#include <exception>

#include "rimod/execution.h"

namespace rimod {

// Thrown out of the library when its work is no longer wanted.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped"; }
};

// The same execution, except that stages and loops throw Stopped soon after stop was set. stop must
// outlive it.
Execution StoppableExecution(Execution execution, const std::atomic<bool>* stop);

}  // namespace rimod
