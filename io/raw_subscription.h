#pragma once

#include <cstddef>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>

#include "io/message_codec.h"

namespace rimod {

// What a subscription tells about the messages that it sees; called from the thread that handles.
struct SubscriptionObserver {
  std::function<void(const std::string& channel)> on_received;
  std::function<void(const std::string& channel, const std::string& cause)> on_rejected;
};

// The name with every character escaped that means something in LCM's regular expressions.
std::string EscapeChannel(const std::string& channel);

// Receives the bytes of one channel until it is destroyed. Nothing that the callback throws gets
// out into LCM (which would be unusable afterwards): it is reported as rejected.
class BytesSubscription {
 public:
  using Callback = std::function<void(const void* bytes, std::size_t size)>;

  // Messages beyond queue_capacity that wait to be handled are lost, the newest first. Throws
  // std::runtime_error when LCM refuses.
  BytesSubscription(lcm::LCM* lcm, const std::string& channel, int queue_capacity,
                    SubscriptionObserver observer, Callback callback);
  ~BytesSubscription();
  BytesSubscription(const BytesSubscription&) = delete;
  BytesSubscription& operator=(const BytesSubscription&) = delete;

 private:
  static void OnMessage(const lcm_recv_buf_t* buffer, const char* channel, void* self);
  void Receive(const lcm_recv_buf_t& buffer) noexcept;

  lcm::LCM* lcm_;
  std::string channel_;
  SubscriptionObserver observer_;
  Callback callback_;
  lcm_subscription_t* subscription_ = nullptr;
};

// Receives messages of one type: on_message returns the cause when it cannot use the message, else
// an empty text.
template <typename Message>
std::unique_ptr<BytesSubscription> SubscribeTo(lcm::LCM* lcm, const std::string& channel,
                                               int queue_capacity,
                                               const SubscriptionObserver& observer,
                                               std::function<std::string(Message)> on_message) {
  auto callback = [channel, observer, on_message](const void* bytes, std::size_t size) {
    Decoded<Message> decoded = DecodeMessage<Message>(bytes, size);
    if (decoded.message) decoded.error = on_message(std::move(*decoded.message));
    if (!decoded.error.empty()) observer.on_rejected(channel, decoded.error);
  };
  return std::make_unique<BytesSubscription>(lcm, channel, queue_capacity, observer, callback);
}

}  // namespace rimod
