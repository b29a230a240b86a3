#include "io/thread_pool.h"

#include <algorithm>
#include <atomic>

namespace rimod {
namespace {

// True in a thread that is running a body: loops inside it must not wait for the pool.
thread_local bool inside_body = false;

}  // namespace

// One call of ParallelFor, on its caller's stack.
struct ThreadPool::Loop {
  std::size_t count = 0;
  const std::function<void(std::size_t)>* body = nullptr;
  std::atomic<std::size_t> next{0};
  int num_working = 0;  // guarded by the pool's mutex

  std::mutex mutex;  // guards the two below
  std::size_t failed_index = 0;
  std::exception_ptr failure;
};

ThreadPool::ThreadPool(int num_threads) {
  const int machine = static_cast<int>(std::thread::hardware_concurrency());
  constexpr int kMost = 256;  // more threads than any machine here has cores
  const int wanted = std::clamp(num_threads > 0 ? num_threads : machine, 1, kMost);
  for (int i = 1; i < wanted; ++i) workers_.emplace_back([this] { Work(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  loop_changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::RunShare(Loop* loop) {
  inside_body = true;
  for (std::size_t i = loop->next++; i < loop->count; i = loop->next++) {
    try {
      (*loop->body)(i);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(loop->mutex);
      if (!loop->failure || i < loop->failed_index) {
        loop->failed_index = i;
        loop->failure = std::current_exception();
      }
    }
  }
  inside_body = false;
}

void ThreadPool::Work() {
  std::unique_lock<std::mutex> lock(mutex_);
  std::size_t seen = 0;
  while (true) {
    loop_changed_.wait(lock, [&] { return stopping_ || (loop_ && generation_ != seen); });
    if (stopping_) return;
    seen = generation_;
    Loop* const loop = loop_;
    ++loop->num_working;
    lock.unlock();
    RunShare(loop);
    lock.lock();
    if (--loop->num_working == 0) loop_changed_.notify_all();
  }
}

void ThreadPool::ParallelFor(std::size_t count, const std::function<void(std::size_t)>& body) {
  if (inside_body || workers_.empty() || count < 2) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  Loop loop;
  loop.count = count;
  loop.body = &body;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    loop_ = &loop;
    ++generation_;
  }
  loop_changed_.notify_all();
  RunShare(&loop);
  {
    std::unique_lock<std::mutex> lock(mutex_);
    loop_ = nullptr;  // a worker that wakes up only now finds nothing to do
    loop_changed_.wait(lock, [&] { return loop.num_working == 0; });
  }
  if (loop.failure) std::rethrow_exception(loop.failure);
}

Execution ThreadPool::MakeExecution() {
  Execution execution;
  execution.parallel_for = [this](std::size_t count, const std::function<void(std::size_t)>& body) {
    ParallelFor(count, body);
  };
  return execution;
}

}  // namespace rimod
