#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "rimod/execution.h"

namespace rimod {

// Runs loops on so many threads.
inline Execution OnThreads(int number) {
  Execution execution;
  execution.parallel_for = [number](std::size_t count,
                                    const std::function<void(std::size_t)>& body) {
    std::atomic<std::size_t> next{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < number; ++i) {
      threads.emplace_back([&] {
        for (std::size_t k = next++; k < count; k = next++) body(k);
      });
    }
    for (std::thread& thread : threads) thread.join();
  };
  return execution;
}

// Runs loops from their end.
inline Execution Backwards() {
  Execution execution;
  execution.parallel_for = [](std::size_t count, const std::function<void(std::size_t)>& body) {
    for (std::size_t i = count; i > 0; --i) body(i - 1);
  };
  return execution;
}

}  // namespace rimod
