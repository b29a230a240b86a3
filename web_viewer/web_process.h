#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/channels.h"
#include "io/config.h"
#include "io/raw_subscription.h"
#include "io/status_reporter.h"
#include "web_viewer/scene_feed.h"
#include "web_viewer/web_content.h"
#include "web_viewer/web_server.h"

namespace lcm {
class LCM;
}

namespace rimod {

// Listens to the pipeline on the bus and keeps what the page shows; tells on RIMOD_STATUS what it
// got and what the server refused.
class WebProcess {
 public:
  // Everything given must outlive it.
  WebProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
             const Configuration& configuration, WebContent* content, const WebServer* server);

  // To be called once in a while.
  void OnIdle();

 private:
  void Take(const std::string& channel, const void* bytes, std::size_t size);

  SceneFeed feed_;
  const WebServer* server_;
  StatusReporter status_;
  std::vector<std::unique_ptr<BytesSubscription>> subscriptions_;
};

}  // namespace rimod
