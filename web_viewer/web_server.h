#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "web_viewer/client_request.h"
#include "web_viewer/page_files.h"
#include "web_viewer/web_content.h"

namespace rimod {

struct WebServerOptions {
  std::string address = "127.0.0.1";  // IPv4, of the network interface to listen on
  int port = 8086;                    // 0: any that is free
  std::vector<std::string>
      host_names;        // that pages may call it by, beside those of the machine itself
  int max_clients = 16;  // pages at a time
};

// What the server refused so far. Counts only grow.
struct WebServerCounters {
  std::atomic<std::int64_t> clients{0};           // pages that came
  std::atomic<std::int64_t> frames{0};            // sent
  std::atomic<std::int64_t> foreign_requests{0};  // another Host or Origin
  std::atomic<std::int64_t> clients_too_many{0};
  std::atomic<std::int64_t> bad_requests{0};  // each ended its connection
};

// Serves the page and sends it what it shows, by HTTP and WebSocket (subprotocol rimod-web), in a
// thread of its own. Requests that name another host, or come from somebody else's page, are
// refused with 403.
class WebServer {
 public:
  using OnCommand = std::function<void(const ClientRequest& request)>;

  // Listens at once. content must outlive it and change neither here nor in the destructor.
  // on_command: told in the server's thread what pages
  // want of the player; may be empty. Throws std::runtime_error where it cannot listen.
  WebServer(const WebServerOptions& options, PageFiles page, WebContent* content,
            OnCommand on_command);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  // The port that it listens on.
  int port() const;
  // Pages that are connected.
  int num_clients() const;
  const WebServerCounters& counters() const;

 private:
  class Connections;
  std::unique_ptr<Connections> connections_;
  std::atomic<bool> stop_{false};
  WebContent* content_;
  std::thread thread_;
};

}  // namespace rimod
