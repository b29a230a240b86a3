#include "web_viewer/web_process.h"

#include <chrono>

namespace rimod {
namespace {

// Sections of some scans: taking one in takes microseconds, a whole scan some milliseconds.
constexpr int kQueueCapacity = 1000;

}  // namespace

WebProcess::WebProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                       const Configuration& configuration, WebContent* content,
                       const WebServer* server)
    : feed_(channels, configuration.bus, &content->scans()),
      server_(server),
      status_(out, channels.status, "rimod-web") {
  for (const std::string& name : feed_.channel_names())
    subscriptions_.push_back(std::make_unique<BytesSubscription>(
        in, name, kQueueCapacity, status_.MakeObserver(),
        [this, name](const void* bytes, std::size_t size) { Take(name, bytes, size); }));
}

void WebProcess::Take(const std::string& channel, const void* bytes, std::size_t size) {
  const TakenMessage taken = feed_.Take(channel, bytes, size, std::chrono::steady_clock::now());
  if (!taken.error.empty()) status_.CountRejected(channel, taken.error);
}

void WebProcess::OnIdle() {
  feed_.GiveUpStale(std::chrono::steady_clock::now());
  status_.SetSectionCounters("scan", feed_.scan_counters());
  status_.SetSectionCounters("range image", feed_.image_counters());
  const WebServerCounters& counters = server_->counters();
  status_.SetGauge("pages", server_->num_clients());
  status_.SetCounter("pages so far", counters.clients);
  status_.SetCounter("frames sent", counters.frames);
  status_.SetCounter("foreign requests refused", counters.foreign_requests);
  status_.SetCounter("pages refused, too many", counters.clients_too_many);
  status_.SetCounter("pages closed for bad requests", counters.bad_requests);
  status_.PublishIfDue();
}

}  // namespace rimod
