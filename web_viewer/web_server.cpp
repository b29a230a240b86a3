#include "web_viewer/web_server.h"

#include <arpa/inet.h>
#include <libwebsockets.h>
#include <netinet/in.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>

#include "web_viewer/client_session.h"
#include "web_viewer/request_rules.h"

namespace rimod {
namespace {

constexpr char kSubprotocol[] = "rimod-web";
// What a page may do: load its own files and talk to the server that it came from.
constexpr char kContentSecurityPolicy[] =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
constexpr std::size_t kChunkBytes = 65'536;  // that a connection is given at a time
constexpr std::size_t kHeaderBytes = 2'048;  // of a reply, generously
// Connections beside those of pages: files that are being loaded.
constexpr int kFurtherConnections = 48;

constexpr lws_retry_bo_t kLiveness = {nullptr,
                                      0,
                                      0,
                                      /*secs_since_valid_ping=*/20,
                                      /*secs_since_valid_hangup=*/40,
                                      0};

std::string HeaderOf(lws* wsi, lws_token_indexes token) {
  const int length = lws_hdr_total_length(wsi, token);
  if (length <= 0) return "";
  std::vector<char> text(static_cast<std::size_t>(length) + 1);
  if (lws_hdr_copy(wsi, text.data(), length + 1, token) < 0) return "";
  return text.data();
}

// Throws for what is no address of this machine: libwebsockets would wait for it to become one.
void CheckAddress(const std::string& text) {
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  if (inet_pton(AF_INET, text.c_str(), &address.sin_addr) != 1)
    throw std::runtime_error("'" + text + "' is no IPv4 address");
  const int probe = socket(AF_INET, SOCK_STREAM, 0);
  const int bound = bind(probe, reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  close(probe);
  if (bound != 0) throw std::runtime_error("this machine does not have the address " + text);
}

// Bytes that go out piece by piece, behind the room that libwebsockets wants in front.
class Outgoing {
 public:
  void Start(std::shared_ptr<const std::string> bytes) {
    bytes_ = std::move(bytes);
    position_ = 0;
  }
  bool active() const { return bytes_ != nullptr; }

  // Writes the next piece. False when the connection is broken. After the last it is inactive.
  bool WriteFrame(lws* wsi) {
    const bool first = position_ == 0;
    const std::size_t size = std::min(kChunkBytes, bytes_->size() - position_);
    const bool last = position_ + size == bytes_->size();
    const int protocol = lws_write_ws_flags(LWS_WRITE_BINARY, first ? 1 : 0, last ? 1 : 0);
    return Write(wsi, size, last, static_cast<lws_write_protocol>(protocol));
  }
  bool WriteFile(lws* wsi) {
    const std::size_t size = std::min(kChunkBytes, bytes_->size() - position_);
    const bool last = position_ + size == bytes_->size();
    return Write(wsi, size, last, last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP);
  }

 private:
  bool Write(lws* wsi, std::size_t size, bool last, lws_write_protocol protocol) {
    std::vector<unsigned char> buffer(LWS_PRE + size);
    std::memcpy(buffer.data() + LWS_PRE, bytes_->data() + position_, size);
    if (lws_write(wsi, buffer.data() + LWS_PRE, size, protocol) < 0) return false;
    position_ += size;
    if (last) bytes_ = nullptr;
    return true;
  }

  std::shared_ptr<const std::string> bytes_;
  std::size_t position_ = 0;
};

struct Client {
  explicit Client(const WebContent* content) : session(content) {}
  ClientSession session;
  RequestBudget budget;
  std::string request;  // as far as it has come
  Outgoing outgoing;
};

}  // namespace

// All of the server's thread, but for what is atomic.
class WebServer::Connections {
 public:
  Connections(const WebServerOptions& options, PageFiles page, WebContent* content,
              OnCommand on_command)
      : options_(options),
        page_(std::move(page)),
        content_(content),
        on_command_(std::move(on_command)) {
    CheckAddress(options_.address);
    lws_set_log_level(LLL_ERR, [](int, const char* line) {
      std::string text(line);
      while (!text.empty() && text.back() == '\n') text.pop_back();
      spdlog::warn("libwebsockets: {}", text);
    });
    lws_context_creation_info info = {};
    info.iface = options_.address.c_str();
    info.port = options_.port;
    info.protocols = protocols_.data();
    info.user = this;
    info.options = LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
    info.timeout_secs = 10;       // to send a request
    info.keepalive_timeout = 10;  // between requests
    info.fd_limit_per_thread =
        static_cast<unsigned int>(options_.max_clients + kFurtherConnections);
    info.retry_and_idle_policy = &kLiveness;
    context_ = lws_create_context(&info);
    if (context_ == nullptr) {
      throw std::runtime_error("cannot listen on " + options_.address + ":" +
                               std::to_string(options_.port) + ": is the port in use?");
    }
  }
  ~Connections() { lws_context_destroy(context_); }
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  // Waits for something to do and does it; false when it cannot go on.
  bool Service() { return lws_service(context_, 0) >= 0; }
  // From any thread: something has changed.
  void Wake() { lws_cancel_service(context_); }

  int port() const { return lws_get_vhost_listen_port(lws_get_vhost_by_name(context_, "default")); }
  int num_clients() const { return num_clients_; }
  const WebServerCounters& counters() const { return counters_; }

 private:
  static int Callback(lws* wsi, lws_callback_reasons reason, void* /*user*/, void* in,
                      std::size_t size) {
    auto* const self = static_cast<Connections*>(lws_context_user(lws_get_context(wsi)));
    try {
      return self->Handle(wsi, reason, static_cast<const char*>(in), size);
    } catch (const std::exception& error) {
      spdlog::error("web server: {}", error.what());
      return -1;
    }
  }

  // 0: go on; -1: close the connection; 1: answered already.
  int Handle(lws* wsi, lws_callback_reasons reason, const char* in, std::size_t size) {
    switch (reason) {
      case LWS_CALLBACK_HTTP:
        return OnHttpRequest(wsi, std::string(in, size));
      case LWS_CALLBACK_HTTP_WRITEABLE:
        return OnHttpWriteable(wsi);
      case LWS_CALLBACK_CLOSED_HTTP:
        files_.erase(wsi);
        return 0;
      case LWS_CALLBACK_HTTP_CONFIRM_UPGRADE:
        return OnUpgrade(wsi);
      case LWS_CALLBACK_ESTABLISHED:
        return OnClient(wsi);
      case LWS_CALLBACK_RECEIVE:
        return OnMessage(wsi, in, size);
      case LWS_CALLBACK_SERVER_WRITEABLE:
        return OnClientWriteable(wsi);
      case LWS_CALLBACK_CLOSED:
        clients_.erase(wsi);
        num_clients_ = static_cast<int>(clients_.size());
        return 0;
      case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
        for (const auto& [client, state] : clients_) lws_callback_on_writable(client);
        return 0;
      default:
        return 0;
    }
  }

  // Empty when the request may be answered, else why not.
  std::string RefusalOf(lws* wsi) {
    const std::string host = HeaderOf(wsi, WSI_TOKEN_HOST);
    const std::string origin = HeaderOf(wsi, WSI_TOKEN_ORIGIN);
    std::string refusal;
    if (!IsAllowedHost(host, options_.host_names)) {
      refusal = "This server does not go by that name (--host-name adds one).";
    } else if (lws_hdr_total_length(wsi, WSI_TOKEN_ORIGIN) > 0 && !IsSameOrigin(origin, host)) {
      refusal = "Another site's page may not use this server.";
    }
    if (!refusal.empty() && counters_.foreign_requests++ == 0)
      spdlog::warn("refused a request to host '{}' from origin '{}'", host, origin);
    return refusal;
  }

  // Sends a short answer; the connection ends with it.
  static int Refuse(lws* wsi, unsigned int code, const std::string& text) {
    lws_return_http_status(wsi, code, text.c_str());
    return -1;
  }

  int OnHttpRequest(lws* wsi, const std::string& path) {
    const std::string refusal = RefusalOf(wsi);
    if (!refusal.empty()) return Refuse(wsi, HTTP_STATUS_FORBIDDEN, refusal);
    if (lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) <= 0)
      return Refuse(wsi, HTTP_STATUS_METHOD_NOT_ALLOWED, "Only GET is answered.");
    const auto file = page_.by_path.find(path);
    if (file == page_.by_path.end())
      return Refuse(wsi, HTTP_STATUS_NOT_FOUND, "There is no such file.");
    if (!SendHeaders(wsi, file->second)) return -1;
    // The page outlives all connections: nothing to own.
    files_[wsi].Start({std::shared_ptr<void>(), &file->second.bytes});
    lws_callback_on_writable(wsi);
    return 0;
  }

  static bool SendHeaders(lws* wsi, const PageFile& file) {
    std::array<unsigned char, LWS_PRE + kHeaderBytes> buffer{};
    unsigned char* const start = buffer.data() + LWS_PRE;
    unsigned char* position = start;
    unsigned char* const end = buffer.data() + buffer.size() - 1;
    if (lws_add_http_common_headers(wsi, HTTP_STATUS_OK, file.mime_type.c_str(), file.bytes.size(),
                                    &position, end) != 0)
      return false;
    const std::array<std::pair<const char*, const char*>, 5> headers = {
        {{"content-security-policy:", kContentSecurityPolicy},
         {"x-content-type-options:", "nosniff"},
         {"cross-origin-resource-policy:", "same-origin"},
         {"referrer-policy:", "no-referrer"},
         {"cache-control:", "no-cache"}}};
    for (const auto& [name, value] : headers) {
      if (lws_add_http_header_by_name(wsi, reinterpret_cast<const unsigned char*>(name),
                                      reinterpret_cast<const unsigned char*>(value),
                                      static_cast<int>(std::strlen(value)), &position, end) != 0)
        return false;
    }
    return lws_finalize_write_http_header(wsi, start, &position, end) == 0;
  }

  int OnHttpWriteable(lws* wsi) {
    const auto file = files_.find(wsi);
    if (file == files_.end() || !file->second.active()) return 0;
    if (!file->second.WriteFile(wsi)) return -1;
    if (file->second.active()) {
      lws_callback_on_writable(wsi);
      return 0;
    }
    files_.erase(file);
    return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
  }

  int OnUpgrade(lws* wsi) {
    std::string refusal = RefusalOf(wsi);
    unsigned int code = HTTP_STATUS_FORBIDDEN;
    if (refusal.empty() && num_clients_ >= options_.max_clients) {
      refusal = "Too many pages are open.";
      code = HTTP_STATUS_SERVICE_UNAVAILABLE;
      ++counters_.clients_too_many;
    }
    if (refusal.empty() && HeaderOf(wsi, WSI_TOKEN_PROTOCOL) != kSubprotocol) {
      refusal = std::string("The subprotocol is ") + kSubprotocol + ".";
      code = HTTP_STATUS_BAD_REQUEST;
    }
    if (refusal.empty()) return 0;
    Refuse(wsi, code, refusal);
    return 1;
  }

  int OnClient(lws* wsi) {
    if (num_clients_ >= options_.max_clients) return -1;
    clients_.emplace(wsi, std::make_unique<Client>(content_));
    num_clients_ = static_cast<int>(clients_.size());
    ++counters_.clients;
    lws_callback_on_writable(wsi);
    return 0;
  }

  int OnMessage(lws* wsi, const char* in, std::size_t size) {
    const auto found = clients_.find(wsi);
    if (found == clients_.end()) return -1;
    Client& client = *found->second;
    if (!client.budget.Take(std::chrono::steady_clock::now()))
      return CloseFor(wsi, LWS_CLOSE_STATUS_POLICY_VIOLATION, "too many messages");
    const std::size_t total = client.request.size() + size + lws_remaining_packet_payload(wsi);
    if (total > kMaxRequestBytes)
      return CloseFor(wsi, LWS_CLOSE_STATUS_MESSAGE_TOO_LARGE, "a message is too long");
    client.request.append(in, size);
    if (lws_remaining_packet_payload(wsi) > 0 || lws_is_final_fragment(wsi) == 0) return 0;
    const std::optional<ClientRequest> request = ParseClientRequest(client.request);
    client.request.clear();
    if (!request || lws_frame_is_binary(wsi) != 0)
      return CloseFor(wsi, LWS_CLOSE_STATUS_POLICY_VIOLATION, "a message is no request");
    if (request->kind == ClientRequest::Kind::kPlayer && on_command_) on_command_(*request);
    client.session.Take(*request);
    lws_callback_on_writable(wsi);
    return 0;
  }

  int CloseFor(lws* wsi, lws_close_status status, const char* cause) {
    if (counters_.bad_requests++ == 0) spdlog::warn("closed the connection to a page: {}", cause);
    std::string text(cause);
    lws_close_reason(wsi, status, reinterpret_cast<unsigned char*>(text.data()), text.size());
    return -1;
  }

  int OnClientWriteable(lws* wsi) {
    const auto found = clients_.find(wsi);
    if (found == clients_.end()) return -1;
    Client& client = *found->second;
    if (!client.outgoing.active()) {
      const std::optional<Frame> frame = client.session.Next();
      if (!frame) return 0;
      client.outgoing.Start(*frame);
      ++counters_.frames;
    }
    if (!client.outgoing.WriteFrame(wsi)) return -1;
    if (client.outgoing.active()) lws_callback_on_writable(wsi);
    return 0;
  }

  // The first serves files, and refuses upgrades before they happen; the end is marked by a null.
  const std::array<lws_protocols, 3> protocols_ = {
      {{"http", &Callback, 0, 0, 0, nullptr, kChunkBytes + LWS_PRE},
       {kSubprotocol, &Callback, 0, kMaxRequestBytes + 1, 0, nullptr, kChunkBytes + LWS_PRE},
       {nullptr, nullptr, 0, 0, 0, nullptr, 0}}};
  const WebServerOptions options_;
  const PageFiles page_;
  WebContent* const content_;
  const OnCommand on_command_;
  lws_context* context_ = nullptr;
  std::map<lws*, std::unique_ptr<Client>> clients_;
  std::map<lws*, Outgoing> files_;  // under way
  std::atomic<int> num_clients_{0};
  WebServerCounters counters_;
};

WebServer::WebServer(const WebServerOptions& options, PageFiles page, WebContent* content,
                     OnCommand on_command)
    : connections_(
          std::make_unique<Connections>(options, std::move(page), content, std::move(on_command))),
      content_(content) {
  content_->OnChange([this] { connections_->Wake(); });
  thread_ = std::thread([this] {
    while (!stop_ && connections_->Service()) {
    }
  });
}

WebServer::~WebServer() {
  content_->OnChange([] {});
  stop_ = true;
  connections_->Wake();
  thread_.join();
}

int WebServer::port() const { return connections_->port(); }
int WebServer::num_clients() const { return connections_->num_clients(); }
const WebServerCounters& WebServer::counters() const { return connections_->counters(); }

}  // namespace rimod
