#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <lcm/lcm-cpp.hpp>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "io/bus_params.h"
#include "io/message_codec.h"

namespace rimod {

// Sends messages in the order given, bursts spread so that receivers with the stock socket buffer
// lose nothing. Has a thread of its own: callers wait only when very much is queued already.
class PacedPublisher {
 public:
  PacedPublisher(lcm::LCM* lcm, const BusParams& params);
  // Sends what is queued, for half a second at most.
  ~PacedPublisher();
  PacedPublisher(const PacedPublisher&) = delete;
  PacedPublisher& operator=(const PacedPublisher&) = delete;

  template <typename Message>
  void Publish(const std::string& channel, const Message& message) {
    PublishBytes(channel, EncodeMessage(message));
  }
  template <typename Message>
  void PublishAll(const std::string& channel, const std::vector<Message>& messages) {
    for (const Message& message : messages) Publish(channel, message);
  }
  void PublishBytes(const std::string& channel, std::vector<std::uint8_t> bytes);

  // Returns when everything given so far has been sent.
  void Flush();
  // Messages that LCM refused to send.
  std::int64_t num_failed() const;

 private:
  struct Item {
    std::string channel;
    std::vector<std::uint8_t> bytes;
  };
  void Send();
  std::chrono::steady_clock::time_point TakeFromBudget(double bytes);  // when it may be sent

  lcm::LCM* lcm_;
  double bytes_per_second_;
  double burst_bytes_;
  double budget_;  // bytes that may be sent at budget_time_
  std::chrono::steady_clock::time_point budget_time_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> queue_;
  std::size_t queued_bytes_ = 0;
  bool sending_ = false;
  bool stopping_ = false;
  std::chrono::steady_clock::time_point give_up_at_;
  std::int64_t num_failed_ = 0;
  std::thread thread_;
};

}  // namespace rimod
