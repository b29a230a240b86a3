#include "io/sender_watch.h"

#include <algorithm>
#include <utility>

#include "io/status_counters.h"

namespace rimod {
namespace {

// Three statuses late: ended, or sending elsewhere.
constexpr auto kSilence = std::chrono::milliseconds(3500);

// Others' statuses must not fill the memory.
constexpr std::size_t kMaxOthers = 64;

}  // namespace

SenderWatch::SenderWatch(lcm::LCM* lcm, const std::string& status_channel,
                         std::vector<std::string> channels, StatusReporter* reporter)
    : channels_(std::move(channels)), reporter_(reporter), self_(reporter->Snapshot()) {
  constexpr int kQueueCapacity = 100;
  for (const std::string& channel : channels_) reporter_->SetGauge(kSendsPrefix + channel, 1);
  SubscriptionObserver observer;  // statuses are no input: they are not counted
  observer.on_rejected = [](const std::string&, const std::string&) {};
  subscription_ =
      SubscribeTo<status_t>(lcm, status_channel, kQueueCapacity, observer,
                            [this](const status_t& status) { return OnStatus(status); });
}

std::string SenderWatch::OnStatus(const status_t& status) {
  if (status.pid == self_.pid && status.host == self_.host) return "";
  std::vector<std::string> channels;
  for (const counter_t& counter : status.counters)
    for (const std::string& channel : channels_)
      if (counter.name == kSendsPrefix + channel) channels.push_back(channel);
  const std::string name =
      status.process + " on " + status.host + ", pid " + std::to_string(status.pid);
  if (channels.empty() || (others_.size() >= kMaxOthers && others_.count(name) == 0)) return "";
  for (const std::string& channel : channels)
    reporter_->ReportError("two senders on " + channel,
                           name + " sends on " + channel + ", too: one of us is too many");
  others_[name] = {now_, std::move(channels)};
  return "";
}

void SenderWatch::Report(Tempo::Time now) {
  now_ = now;
  if (others_.empty()) return;
  std::map<std::string, std::int64_t> numbers;
  for (const std::string& channel : channels_) numbers[channel] = 0;
  for (auto other = others_.begin(); other != others_.end();) {
    if (now - other->second.heard > kSilence) {
      other = others_.erase(other);
      continue;
    }
    for (const std::string& channel : other->second.channels) ++numbers[channel];
    ++other;
  }
  for (const auto& [channel, number] : numbers)
    reporter_->SetGauge("other senders on " + channel, number);
}

}  // namespace rimod
