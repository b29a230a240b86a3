#include "io/stoppable.h"

#include <utility>

namespace rimod {

Execution StoppableExecution(Execution execution, const std::atomic<bool>* stop) {
  const auto throw_if_stopped = [stop] {
    if (*stop) throw Stopped();
  };
  Execution stoppable = execution;
  stoppable.parallel_for = [run = std::move(execution.parallel_for), throw_if_stopped](
                               std::size_t count, const std::function<void(std::size_t)>& body) {
    throw_if_stopped();
    run(count, [&body, &throw_if_stopped](std::size_t i) {
      throw_if_stopped();
      body(i);
    });
  };
  stoppable.on_stage_begin = [begin = std::move(execution.on_stage_begin),
                              throw_if_stopped](const std::string& stage) {
    throw_if_stopped();
    begin(stage);
  };
  return stoppable;
}

}  // namespace rimod
