#include "io/paced_publisher.h"

#include <algorithm>

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxQueuedBytes = 256'000'000;  // callers wait beyond
constexpr auto kFarewell = std::chrono::milliseconds(500);

}  // namespace

PacedPublisher::PacedPublisher(lcm::LCM* lcm, const BusParams& params)
    : lcm_(lcm),
      bytes_per_second_(params.max_megabytes_per_second * 1e6),
      burst_bytes_(params.burst_kilobytes * 1e3),
      budget_(burst_bytes_),
      budget_time_(Clock::now()),
      give_up_at_(Clock::time_point::max()),
      thread_([this] { Send(); }) {}

PacedPublisher::~PacedPublisher() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    give_up_at_ = Clock::now() + kFarewell;
  }
  changed_.notify_all();
  thread_.join();
}

void PacedPublisher::PublishBytes(const std::string& channel, std::vector<std::uint8_t> bytes) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return stopping_ || queued_bytes_ <= kMaxQueuedBytes; });
  if (stopping_) return;
  queued_bytes_ += bytes.size();
  queue_.push_back({channel, std::move(bytes)});
  lock.unlock();
  changed_.notify_all();
}

void PacedPublisher::Flush() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return queue_.empty() && !sending_; });
}

std::int64_t PacedPublisher::num_failed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return num_failed_;
}

void PacedPublisher::Send() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
    if (queue_.empty() || Clock::now() > give_up_at_) break;
    sending_ = true;
    const Item item = std::move(queue_.front());
    queue_.pop_front();
    queued_bytes_ -= item.bytes.size();
    const auto start = TakeFromBudget(static_cast<double>(item.bytes.size()));
    lock.unlock();
    changed_.notify_all();
    std::this_thread::sleep_until(start);
    const int status = lcm_->publish(item.channel, item.bytes.data(),
                                     static_cast<unsigned int>(item.bytes.size()));
    lock.lock();
    sending_ = false;
    if (status != 0) ++num_failed_;
    if (queue_.empty()) changed_.notify_all();
  }
  queue_.clear();
  changed_.notify_all();
}

// The budget grows with time up to one burst; a message may go once the budget covers it, or the
// burst where it is larger than that.
Clock::time_point PacedPublisher::TakeFromBudget(double bytes) {
  const auto now = Clock::now();
  const double rest = std::chrono::duration<double>(now - budget_time_).count();
  budget_ = std::min(burst_bytes_, budget_ + rest * bytes_per_second_);
  budget_time_ = now;
  const double missing = std::min(bytes, burst_bytes_) - budget_;
  budget_ -= bytes;
  if (missing <= 0.0) return now;
  return now + std::chrono::duration_cast<Clock::duration>(
                   std::chrono::duration<double>(missing / bytes_per_second_));
}

}  // namespace rimod
