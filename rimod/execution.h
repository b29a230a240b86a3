#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace rimod {

// How a caller lets the library work: who runs its loops and who watches its stages. The library
// has no threads and no clock of its own. The default runs all in the calling thread, unwatched.
struct Execution {
  // Calls body(i) for every i in [0, count), in any order, on any threads, and returns when all are
  // done. Results do not depend on the order: body(i) writes slot i only.
  std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>
      parallel_for = [](std::size_t count, const std::function<void(std::size_t)>& body) {
        for (std::size_t i = 0; i < count; ++i) body(i);
      };
  // Called with a stage's name when it begins and when it has ended; stages do not nest.
  std::function<void(const std::string& stage)> on_stage_begin = [](const std::string&) {};
  std::function<void(const std::string& stage)> on_stage_end = [](const std::string&) {};
};

// Watches one stage from construction to destruction.
class StageScope {
 public:
  StageScope(const Execution& execution, std::string stage)
      : execution_(execution), stage_(std::move(stage)) {
    execution_.on_stage_begin(stage_);
  }
  ~StageScope() { execution_.on_stage_end(stage_); }
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  const Execution& execution_;
  std::string stage_;
};

}  // namespace rimod
