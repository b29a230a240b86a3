#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/message_codec.h"
#include "rimod/status_t.hpp"

namespace rimod {

// A test's ear and mouth on the bus: keeps all messages by channel.
class BusProbe {
 public:
  BusProbe();
  BusProbe(const BusProbe&) = delete;
  BusProbe& operator=(const BusProbe&) = delete;

  void Publish(const std::string& channel, const std::vector<std::uint8_t>& bytes);
  template <typename Message>
  void Publish(const std::string& channel, const Message& message) {
    Publish(channel, EncodeMessage(message));
  }
  // With pauses, so that nobody loses a section.
  template <typename Message>
  void PublishAll(const std::string& channel, const std::vector<Message>& messages) {
    for (const Message& message : messages) {
      Publish(channel, message);
      Listen(std::chrono::milliseconds(2));
    }
  }

  void Listen(std::chrono::milliseconds duration);
  // Listens until the condition holds; false when it does not within the timeout.
  bool ListenUntil(const std::function<bool()>& condition, std::chrono::milliseconds timeout);

  const std::vector<std::vector<std::uint8_t>>& Bytes(const std::string& channel) {
    return received_[channel];
  }
  // All messages of a channel; those that cannot be decoded are left out.
  template <typename Message>
  std::vector<Message> Messages(const std::string& channel) {
    std::vector<Message> messages;
    for (const std::vector<std::uint8_t>& bytes : received_[channel]) {
      Decoded<Message> decoded = DecodeMessage<Message>(bytes.data(), bytes.size());
      if (decoded.message) messages.push_back(std::move(*decoded.message));
    }
    return messages;
  }
  // A short sum of each message of a channel whose first field, utime, is this one. Equal sums mean
  // equal bytes; other than those, they can be printed.
  std::vector<std::string> Sums(const std::string& channel, std::int64_t utime) const;
  // The last status of an executable.
  std::optional<status_t> Status(const std::string& executable);
  void Forget() { received_.clear(); }

 private:
  static void OnMessage(const lcm_recv_buf_t* buffer, const char* channel, void* self);

  lcm::LCM lcm_;
  std::map<std::string, std::vector<std::vector<std::uint8_t>>> received_;
};

// Size and FNV-1a hash of an encoded message.
std::string SumOf(const std::vector<std::uint8_t>& bytes);
template <typename Message>
std::vector<std::string> SumsOf(const std::vector<Message>& messages) {
  std::vector<std::string> sums;
  for (const Message& message : messages) sums.push_back(SumOf(EncodeMessage(message)));
  return sums;
}

// A counter of a status by its name, which may leave out "dropped "; 0 where it is not listed.
std::int64_t CounterOf(const status_t& status, const std::string& name);

}  // namespace rimod
