#include "io/paced_publisher.h"

#include <algorithm>

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxQueuedBytes = 256'000'000;  // callers wait beyond
constexpr auto kFarewell = std::chrono::milliseconds(500);

// Where this thread is woken late, the machine is busy and receivers are woken late too, some
// later: they get that many times the lateness, measured with lcm-logger beside busy loops
// (docs/benchmarks.md).
constexpr int kLatenessFactor = 4;
constexpr auto kMaxPause = std::chrono::milliseconds(50);

}  // namespace

PacedPublisher::PacedPublisher(lcm::LCM* lcm, const BusParams& params, const Tempo& tempo)
    : lcm_(lcm),
      bytes_per_second_(params.max_megabytes_per_second * 1e6),
      at_once_(tempo.at_once()),
      free_at_(Clock::now()),
      give_up_at_(Clock::time_point::max()) {
  if (!at_once_) thread_ = std::thread([this] { Send(); });
}

PacedPublisher::~PacedPublisher() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    give_up_at_ = Clock::now() + kFarewell;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void PacedPublisher::PublishBytes(const std::string& channel, std::vector<std::uint8_t> bytes,
                                  int slowness) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (at_once_) {
    const int status =
        lcm_->publish(channel, bytes.data(), static_cast<unsigned int>(bytes.size()));
    if (status != 0) ++num_failed_;
    return;
  }
  changed_.wait(lock, [this] { return stopping_ || queued_bytes_ <= kMaxQueuedBytes; });
  if (stopping_) return;
  queued_bytes_ += bytes.size();
  queue_.push_back({channel, std::move(bytes), slowness});
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

std::int64_t PacedPublisher::num_waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<std::int64_t>(queue_.size());
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
    lock.unlock();
    changed_.notify_all();
    WaitUntilFree();
    const int status = lcm_->publish(item.channel, item.bytes.data(),
                                     static_cast<unsigned int>(item.bytes.size()));
    PauseAfter(item);
    lock.lock();
    sending_ = false;
    if (status != 0) ++num_failed_;
    if (queue_.empty()) changed_.notify_all();
  }
  queue_.clear();
  changed_.notify_all();
}

void PacedPublisher::WaitUntilFree() {
  const auto now = Clock::now();
  if (now >= free_at_) {
    lateness_ = {};
    return;
  }
  std::this_thread::sleep_until(free_at_);
  lateness_ = std::max(Clock::now() - free_at_, lateness_ * 4 / 5);
}

// Counted from the sending itself: a sender that was late must not catch up.
void PacedPublisher::PauseAfter(const Item& item) {
  const auto at_rate = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
      static_cast<double>(item.bytes.size()) * item.slowness / bytes_per_second_));
  const bool large = item.bytes.size() > kSectionBytes / 10;
  const auto for_receivers = large
                                 ? std::min<Clock::duration>(kLatenessFactor * lateness_, kMaxPause)
                                 : Clock::duration{0};
  free_at_ = Clock::now() + std::max(at_rate, for_receivers);
}

}  // namespace rimod
