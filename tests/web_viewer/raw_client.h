#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cstdint>
#include <optional>
#include <string>

namespace rimod {

// A client that says exactly what a test wants: HTTP text, WebSocket frames, or less than that.
class RawClient {
 public:
  explicit RawClient(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval patience{10, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ =
        connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  }
  ~RawClient() { close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool connected() const { return connected_; }

  // False when the other side does not take it any more.
  bool Send(const std::string& bytes) {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t size = send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (size <= 0) return false;
      sent += static_cast<std::size_t>(size);
    }
    return true;
  }

  // So many bytes; fewer when the connection ends.
  std::string Receive(std::size_t size) {
    std::string bytes(size, '\0');
    std::size_t received = 0;
    while (received < size) {
      const ssize_t part = recv(socket_, bytes.data() + received, size - received, 0);
      if (part <= 0) break;
      received += static_cast<std::size_t>(part);
    }
    bytes.resize(received);
    return bytes;
  }
  // Everything up to an empty line.
  std::string ReceiveHead() {
    std::string head;
    while (head.size() < 20'000 && head.find("\r\n\r\n") == std::string::npos) {
      const std::string next = Receive(1);
      if (next.empty()) break;
      head += next;
    }
    return head;
  }

  // Asks for a WebSocket; returns the status line.
  std::string Upgrade(const std::string& host, const std::string& origin,
                      const std::string& subprotocol = "rimod-web") {
    Send("GET / HTTP/1.1\r\nHost: " + host + "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n" +
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n" +
         (origin.empty() ? "" : "Origin: " + origin + "\r\n") +
         (subprotocol.empty() ? "" : "Sec-WebSocket-Protocol: " + subprotocol + "\r\n") + "\r\n");
    const std::string head = ReceiveHead();
    return head.substr(0, head.find("\r\n"));
  }

  // Sends a masked frame; a text message by default.
  bool SendFrame(const std::string& payload, int first_byte = 0x81) {
    std::string frame(1, static_cast<char>(first_byte));
    if (payload.size() < 126) {
      frame.push_back(static_cast<char>(0x80 | payload.size()));
    } else {
      frame.push_back(static_cast<char>(0x80 | 127));
      for (int shift = 56; shift >= 0; shift -= 8)
        frame.push_back(static_cast<char>(payload.size() >> shift & 0xff));
    }
    frame += std::string(4, '\0');  // the mask that changes nothing
    return Send(frame + payload);
  }

  // The payload of the next message; pings are passed over, a close or an end gives nothing.
  std::optional<std::string> ReceiveMessage() {
    std::string message;
    while (true) {
      const std::string head = Receive(2);
      if (head.size() < 2) return std::nullopt;
      const int opcode = head[0] & 0x0f;
      const bool is_final = (head[0] & 0x80) != 0;
      std::uint64_t size = static_cast<std::uint8_t>(head[1]) & 0x7f;
      if (size >= 126) {
        const std::string length = Receive(size == 126 ? 2 : 8);
        size = 0;
        for (const char byte : length) size = size << 8 | static_cast<std::uint8_t>(byte);
      }
      const std::string payload = Receive(size);
      if (payload.size() < size) return std::nullopt;
      if (opcode == 8) {
        if (payload.size() >= 2)
          close_status_ =
              static_cast<std::uint8_t>(payload[0]) << 8 | static_cast<std::uint8_t>(payload[1]);
        return std::nullopt;
      }
      if (opcode > 8) continue;
      message += payload;
      if (is_final) return message;
    }
  }
  // Of the close frame that ended the messages; 0: there was none.
  int close_status() const { return close_status_; }

 private:
  int socket_;
  bool connected_ = false;
  int close_status_ = 0;
};

}  // namespace rimod
