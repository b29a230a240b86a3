#include "io/stage_timer.h"

#include <algorithm>

namespace rimod {

void StageTimer::Watch(Execution* execution) {
  execution->on_stage_begin = [this](const std::string&) {
    begin_ = std::chrono::steady_clock::now();
  };
  execution->on_stage_end = [this](const std::string& stage) {
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - begin_;
    Add(stage, elapsed.count());
  };
}

void StageTimer::Add(const std::string& stage, double ms) {
  const auto found = std::find_if(times_.begin(), times_.end(),
                                  [&](const auto& time) { return time.first == stage; });
  if (found == times_.end()) {
    times_.emplace_back(stage, ms);
  } else {
    found->second += ms;
  }
}

}  // namespace rimod
