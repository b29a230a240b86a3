#pragma once

#include <atomic>
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
// Items of a second rank are worked on only while no others wait.
template <typename Item>
class NewestWorker {
 public:
  // prepare is called before each item and after each Poke(); neither callback may throw. at_once:
  // there is no thread, all work is done by the caller while it gives the item, none is overtaken.
  NewestWorker(int max_waiting, std::function<void()> prepare, std::function<void(Item)> work,
               bool at_once = false)
      : max_waiting_(static_cast<std::size_t>(max_waiting)),
        at_once_(at_once),
        prepare_(std::move(prepare)),
        work_(std::move(work)) {
    if (!at_once_) thread_ = std::thread([this] { Run(); });
  }

  // What waits is left undone; the item at hand is finished.
  ~NewestWorker() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }
  NewestWorker(const NewestWorker&) = delete;
  NewestWorker& operator=(const NewestWorker&) = delete;

  // Returns the number of items (0 or 1) that this one pushed out.
  int Give(Item item) {
    if (at_once_) return WorkAtOnce(std::move(item));
    int num_overtaken = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      waiting_.push_back(std::move(item));
      if (waiting_.size() > max_waiting_) {
        waiting_.pop_front();
        ++num_overtaken;
      }
      wanted_ = true;
    }
    changed_.notify_all();
    return num_overtaken;
  }

  // An item of the second rank: one waits, a newer one takes its place. Returns as Give().
  int GiveWhenIdle(Item item) {
    if (at_once_) return WorkAtOnce(std::move(item));
    int num_overtaken = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (idle_item_) ++num_overtaken;
      idle_item_ = std::move(item);
    }
    changed_.notify_all();
    return num_overtaken;
  }

  // Set while an item of the first rank waits: work on one of the second should end then.
  const std::atomic<bool>& wanted() const { return wanted_; }

  // Items that wait; the one at hand is not among them.
  std::size_t num_waiting() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return waiting_.size();
  }

  // Has prepare called, also when there is no item.
  void Poke() {
    if (at_once_) return prepare_();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      poked_ = true;
    }
    changed_.notify_all();
  }

 private:
  int WorkAtOnce(Item item) {
    prepare_();
    work_(std::move(item));
    return 0;
  }

  void Run() {
    while (true) {
      {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [this] {
          return stopping_ || poked_ || !waiting_.empty() || idle_item_.has_value();
        });
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
    if (stopping_) return std::nullopt;
    if (waiting_.empty()) return std::exchange(idle_item_, std::nullopt);
    std::optional<Item> item(std::move(waiting_.front()));
    waiting_.pop_front();
    wanted_ = !waiting_.empty();
    return item;
  }

  const std::size_t max_waiting_;
  const bool at_once_;
  const std::function<void()> prepare_;
  const std::function<void(Item)> work_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> waiting_;
  std::optional<Item> idle_item_;
  std::atomic<bool> wanted_{false};  // !waiting_.empty()
  bool poked_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace rimod
