#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <utility>

#include "io/stage_timer.h"

namespace rimod {

// By which clock a process on the bus goes, and whether its work waits. Live: the steady clock;
// work and sending have threads of their own, and the newest scan overtakes others. In a replay:
// the log's clock; all is done at once in the calling thread, so that nothing is overtaken and the
// same log gives the same messages.
class Tempo {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using OnStageTimes = std::function<void(std::int64_t utime, const StageTimes& times)>;

  // Live.
  Tempo() = default;
  // A replay's. now gives the log's time, on_stage_times is told the stages of each scan.
  Tempo(std::function<Time()> now, OnStageTimes on_stage_times)
      : now_(std::move(now)), on_stage_times_(std::move(on_stage_times)) {}

  bool at_once() const { return now_ != nullptr; }
  Time Now() const { return now_ ? now_() : std::chrono::steady_clock::now(); }
  void TellStageTimes(std::int64_t utime, const StageTimes& times) const {
    if (on_stage_times_) on_stage_times_(utime, times);
  }

 private:
  std::function<Time()> now_;
  OnStageTimes on_stage_times_;
};

}  // namespace rimod
