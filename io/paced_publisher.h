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
#include "io/tempo.h"

namespace rimod {

// Sends messages in the order given, each followed by a pause as long as its bytes take at the
// allowed rate, longer on a busy machine, so that receivers with the stock socket buffer lose
// nothing. Has a thread of its own: callers wait only when very much is queued already. In a replay
// it sends at once, without thread and pauses.
class PacedPublisher {
 public:
  PacedPublisher(lcm::LCM* lcm, const BusParams& params, const Tempo& tempo = {});
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
  // At half the rate: for what nobody waits for, while others send, too.
  template <typename Message>
  void PublishAllSlowly(const std::string& channel, const std::vector<Message>& messages) {
    for (const Message& message : messages)
      PublishBytes(channel, EncodeMessage(message), /*slowness=*/2);
  }
  // The pause after it is slowness times as long as the rate asks for.
  void PublishBytes(const std::string& channel, std::vector<std::uint8_t> bytes, int slowness = 1);

  // Returns when everything given so far has been sent.
  void Flush();
  // Messages that LCM refused to send.
  std::int64_t num_failed() const;
  // Messages that wait for their turn.
  std::int64_t num_waiting() const;

 private:
  struct Item {
    std::string channel;
    std::vector<std::uint8_t> bytes;
    int slowness;
  };
  void Send();
  void WaitUntilFree();
  void PauseAfter(const Item& item);

  lcm::LCM* lcm_;
  double bytes_per_second_;
  const bool at_once_;
  std::chrono::steady_clock::time_point free_at_;  // when the next message may be sent
  // Of the sending thread:
  std::chrono::steady_clock::duration lateness_{0};  // of waking up, of late

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
