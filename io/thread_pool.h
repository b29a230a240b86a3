#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "rimod/execution.h"

namespace rimod {

// A fixed number of threads for the library's loops.
class ThreadPool {
 public:
  // num_threads counts the calling thread; 0 or less: as many as the machine has.
  explicit ThreadPool(int num_threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int num_threads() const { return static_cast<int>(workers_.size()) + 1; }

  // Calls body(i) for each i in [0, count) and returns when all are done. The first exception (by
  // index) that a body throws is thrown again here, after all others have ended. A call from inside
  // a body runs in that thread alone. One caller at a time.
  void ParallelFor(std::size_t count, const std::function<void(std::size_t)>& body);

  // An execution that runs on this pool, which must outlive it; unwatched.
  Execution MakeExecution();

 private:
  struct Loop;
  void Work();
  static void RunShare(Loop* loop);

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable loop_changed_;
  Loop* loop_ = nullptr;        // the one at hand
  std::size_t generation_ = 0;  // counts loops
  bool stopping_ = false;
};

}  // namespace rimod
