#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace rimod {

// Works on items, one at a time, in a thread of its own, so that whoever gives them can go on
// receiving. Where work is slower than what comes in, the oldest waiting items are overtaken.
template <typename Item>
class NewestWorker {
 public:
  // prepare is called before each item and after each Poke(); neither callback may throw.
  NewestWorker(int max_waiting, std::function<void()> prepare, std::function<void(Item)> work)
      : max_waiting_(static_cast<std::size_t>(max_waiting)),
        prepare_(std::move(prepare)),
        work_(std::move(work)),
        thread_([this] { Run(); }) {}

  // What waits is left undone; the item at hand is finished.
  ~NewestWorker() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  NewestWorker(const NewestWorker&) = delete;
  NewestWorker& operator=(const NewestWorker&) = delete;

  // Returns the number of items (0 or 1) that this one pushed out.
  int Give(Item item) {
    int num_overtaken = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      waiting_.push_back(std::move(item));
      if (waiting_.size() > max_waiting_) {
        waiting_.pop_front();
        ++num_overtaken;
      }
    }
    changed_.notify_all();
    return num_overtaken;
  }

  // Has prepare called, also when there is no item.
  void Poke() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      poked_ = true;
    }
    changed_.notify_all();
  }

 private:
  void Run() {
    while (true) {
      {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [this] { return stopping_ || poked_ || !waiting_.empty(); });
        if (stopping_) return;
        poked_ = false;
      }
      prepare_();
      // Taken only now: preparing may take long, and the newest counts.
      std::optional<Item> item = Take();
      if (item) work_(std::move(*item));
    }
  }

  std::optional<Item> Take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stopping_ || waiting_.empty()) return std::nullopt;
    std::optional<Item> item(std::move(waiting_.front()));
    waiting_.pop_front();
    return item;
  }

  const std::size_t max_waiting_;
  const std::function<void()> prepare_;
  const std::function<void(Item)> work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> waiting_;
  bool poked_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace rimod
