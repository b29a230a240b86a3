#include "tests/support/bus_probe.h"

#include <stdexcept>

#include "io/process_options.h"
#include "io/status_counters.h"

namespace rimod {

using Clock = std::chrono::steady_clock;

BusProbe::BusProbe() : lcm_(kDefaultLcmUrl) {
  if (!lcm_.good()) throw std::runtime_error("no LCM in the private network");
  constexpr int kPlenty = 100000;
  // Not lcm_.subscribe(): GCC 12's -fsanitize=undefined breaks its call of the member function.
  lcm_subscription_t* const all =
      lcm_subscribe(lcm_.getUnderlyingLCM(), ".*", &BusProbe::OnMessage, this);
  lcm_subscription_set_queue_capacity(all, kPlenty);
}

void BusProbe::Publish(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
  lcm_.publish(channel, bytes.data(), static_cast<unsigned int>(bytes.size()));
}

void BusProbe::Listen(std::chrono::milliseconds duration) {
  ListenUntil([] { return false; }, duration);
}

bool BusProbe::ListenUntil(const std::function<bool()>& condition,
                           std::chrono::milliseconds timeout) {
  const auto end = Clock::now() + timeout;
  while (!condition()) {
    if (Clock::now() >= end) return false;
    lcm_.handleTimeout(1);
  }
  return true;
}

std::vector<std::string> BusProbe::Sums(const std::string& channel, std::int64_t utime) const {
  std::vector<std::string> sums;
  const auto found = received_.find(channel);
  if (found == received_.end()) return sums;
  for (const std::vector<std::uint8_t>& bytes : found->second) {
    std::uint64_t first_field = 0;
    for (std::size_t i = 8; i < 16 && i < bytes.size(); ++i) {
      first_field = first_field << 8 | bytes[i];
    }
    if (first_field == static_cast<std::uint64_t>(utime)) sums.push_back(SumOf(bytes));
  }
  return sums;
}

std::optional<status_t> BusProbe::Status(const std::string& executable) {
  std::optional<status_t> last;
  for (status_t& status : Messages<status_t>("RIMOD_STATUS")) {
    if (status.process == executable) last = std::move(status);
  }
  return last;
}

void BusProbe::OnMessage(const lcm_recv_buf_t* buffer, const char* channel, void* self) {
  const auto* const bytes = static_cast<const std::uint8_t*>(buffer->data);
  static_cast<BusProbe*>(self)->received_[channel].emplace_back(bytes, bytes + buffer->data_size);
}

std::string SumOf(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 1099511628211ULL;
  return std::to_string(bytes.size()) + " bytes " + std::to_string(hash);
}

std::int64_t CounterOf(const status_t& status, const std::string& name) {
  for (const counter_t& counter : status.counters) {
    if (counter.name == name || counter.name == kDroppedPrefix + name) return counter.value;
  }
  return 0;
}

}  // namespace rimod
