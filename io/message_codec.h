#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "io/message_shape.h"

namespace rimod {

// No message of ours is longer: the stock receive buffer takes it (docs/lcm.md).
constexpr int kMaxMessageBytes = 180000;
// What large things are cut into: one UDP datagram each.
constexpr int kSectionBytes = 60000;

// Messages of others may be longer, but not without bound.
constexpr std::size_t kMaxForeignMessageBytes = 16000000;

// The encoded message. Count fields must fit their lists: only conversions set them.
template <typename Message>
std::vector<std::uint8_t> EncodeMessage(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

template <typename Message>
struct Decoded {
  std::optional<Message> message;
  std::string error;  // the cause, one of few; empty when there is a message
};

// Decodes bytes of unknown origin: whatever they are, it neither throws nor allocates more than a
// few times their size. All of them must belong to the message.
template <typename Message>
Decoded<Message> DecodeMessage(const void* bytes, std::size_t size) {
  std::string error =
      CheckBytes(bytes, size, kMaxForeignMessageBytes, Message::getHash(), &WalkShape<Message>);
  if (!error.empty()) return {std::nullopt, std::move(error)};
  try {
    Message message;
    const int decoded = message.decode(bytes, 0, static_cast<int>(size));
    if (decoded == static_cast<int>(size)) return {std::move(message), ""};
  } catch (const std::exception&) {
    // Falls through: the walk leaves no reason to get here, a decoder may still differ.
  }
  return {std::nullopt, "cannot be decoded"};
}

}  // namespace rimod
