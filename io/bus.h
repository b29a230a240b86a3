#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <lcm/lcm-cpp.hpp>

namespace rimod {

// Makes SIGINT and SIGTERM set a flag instead of ending the process, for as long as it lives. One
// at a time.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  const std::atomic<bool>& stop() const;
};

// Handles messages until stop is set: waits for some, handles all that wait, calls on_idle, which
// happens once in an idle period at least. Returns true when stopped, false when LCM fails again
// and again (a closed log, a vanished network).
bool RunBus(lcm::LCM* lcm, const std::atomic<bool>& stop, const std::function<void()>& on_idle,
            std::chrono::milliseconds idle_period = std::chrono::milliseconds(50));

}  // namespace rimod
