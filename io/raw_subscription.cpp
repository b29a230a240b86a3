#include "io/raw_subscription.h"

#include <exception>
#include <stdexcept>

namespace rimod {

std::string EscapeChannel(const std::string& channel) {
  std::string escaped;
  for (const char c : channel) {
    if (std::string("\\^$.|?*+()[]{}").find(c) != std::string::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

BytesSubscription::BytesSubscription(lcm::LCM* lcm, const std::string& channel, int queue_capacity,
                                     SubscriptionObserver observer, Callback callback)
    : lcm_(lcm), channel_(channel), observer_(std::move(observer)), callback_(std::move(callback)) {
  subscription_ =
      lcm_subscribe(lcm_->getUnderlyingLCM(), EscapeChannel(channel).c_str(), &OnMessage, this);
  if (subscription_ == nullptr) {
    throw std::runtime_error("LCM refuses to subscribe to channel '" + channel + "'");
  }
  lcm_subscription_set_queue_capacity(subscription_, queue_capacity);
}

BytesSubscription::~BytesSubscription() {
  lcm_unsubscribe(lcm_->getUnderlyingLCM(), subscription_);
}

void BytesSubscription::OnMessage(const lcm_recv_buf_t* buffer, const char* /*channel*/,
                                  void* self) {
  static_cast<BytesSubscription*>(self)->Receive(*buffer);
}

void BytesSubscription::Receive(const lcm_recv_buf_t& buffer) noexcept {
  try {
    if (observer_.on_received) observer_.on_received(channel_);
    try {
      callback_(buffer.data, buffer.data_size);
    } catch (const std::exception& error) {
      if (observer_.on_rejected) observer_.on_rejected(channel_, error.what());
    }
  } catch (...) {
    // Only an observer that fails itself gets here: nobody is left to tell.
  }
}

}  // namespace rimod
