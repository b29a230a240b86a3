#include "viewer_tools/meldis_process.h"

#include <spdlog/spdlog.h>

#include "io/message_codec.h"
#include "viewer_tools/meldis_messages.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kQueueCapacity = 1000;  // some whole scans, in sections
constexpr std::size_t kMaxTold = 64;  // different complaints
constexpr auto kLeastPeriod = std::chrono::milliseconds(500);
constexpr auto kRepeatPeriod = std::chrono::seconds(2);

template <typename Message>
void Publish(lcm::LCM* lcm, const char* channel, const Message& message) {
  const std::vector<std::uint8_t> bytes = EncodeMessage(message);
  lcm->publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
}

}  // namespace

MeldisProcess::MeldisProcess(lcm::LCM* lcm, const Channels& channels, const BusParams& params)
    : lcm_(lcm), follower_(channels, params) {
  SubscriptionObserver observer;
  observer.on_received = [](const std::string&) {};
  observer.on_rejected = [this](const std::string& channel, const std::string& cause) {
    Complain(channel, cause);
  };
  for (const std::string& name : follower_.channel_names())
    subscriptions_.push_back(std::make_unique<BytesSubscription>(
        lcm, name, kQueueCapacity, observer,
        [this, name](const void* bytes, std::size_t size) { Take(name, bytes, size); }));
}

void MeldisProcess::Take(const std::string& channel, const void* bytes, std::size_t size) {
  const std::string cause = follower_.Take(channel, bytes, size, Clock::now());
  if (!cause.empty()) Complain(channel, cause);
}

void MeldisProcess::Complain(const std::string& channel, const std::string& cause) {
  const bool is_new = told_.size() < kMaxTold && told_.insert(channel + ": " + cause).second;
  if (is_new) spdlog::warn("{}: message left out: {}", channel, cause);
}

void MeldisProcess::OnIdle() {
  const ViewedScan* const scan = follower_.newest();
  if (scan == nullptr) return;
  const bool is_new = follower_.newest_version() != sent_version_;
  if (Clock::now() - sent_at_ < (is_new ? Clock::duration(kLeastPeriod) : kRepeatPeriod)) return;
  Send(*scan);
}

void MeldisProcess::Send(const ViewedScan& scan) {
  sent_version_ = follower_.newest_version();
  sent_at_ = Clock::now();
  std::vector<Detection> detections;
  if (scan.detections) {
    detections = scan.detections->detections;
  } else if (scan.early) {
    for (const EarlyObject& object : scan.early->objects)
      if (object.status != EarlyStatus::kWithdrawn) detections.push_back(object.detection);
  }
  Publish(lcm_, kMeldisCloudChannel, MeldisCloud(*scan.image, scan.utime));
  Publish(lcm_, kMeldisLoadChannel, MeldisScene(detections));
  Publish(lcm_, kMeldisDrawChannel,
          MeldisPoses(detections, scan.image->T_local_sensor(), scan.utime));
}

}  // namespace rimod
