#include "web_viewer/web_server.h"

#include <gtest/gtest.h>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include <chrono>
#include <memory>
#include <thread>

#include "io/scan_messages.h"
#include "tests/support/bus_probe.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"
#include "tests/web_viewer/decoded_frame.h"
#include "tests/web_viewer/raw_client.h"

namespace rimod {
namespace {

constexpr char kHost[] = "localhost:8086";
constexpr char kOrigin[] = "http://localhost:8086";
constexpr char kShown[] = R"({"type":"shown"})";

Scan ScanOfPoints(std::size_t count) {
  Scan scan;
  for (std::size_t i = 0; i < count; ++i)
    scan.points.emplace_back(1.0f, 0.001f * static_cast<float>(i % 1000), 0.2f);
  return scan;
}

// True as soon as the condition holds, false when it does not within ten seconds.
template <typename Condition>
bool Eventually(Condition condition) {
  for (int i = 0; i < 1000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

class WebServerTest : public testing::Test {
 protected:
  static PageFiles Page() {
    PageFiles page;
    page.by_path["/"] = {"text/html; charset=utf-8", "<p>page</p>"};
    page.by_path["/page.js"] = {"text/javascript; charset=utf-8", std::string(300'000, 'x')};
    return page;
  }
  static WebServerOptions AnyPort() {
    WebServerOptions options;
    options.port = 0;
    options.max_clients = 3;
    return options;
  }

  std::string Get(const std::string& path, const std::string& headers) {
    RawClient client(server_.port());
    client.Send("GET " + path + " HTTP/1.1\r\n" + headers + "\r\n");
    const std::string head = client.ReceiveHead();
    return head.substr(0, head.find("\r\n"));
  }
  std::unique_ptr<RawClient> Connect() {
    auto client = std::make_unique<RawClient>(server_.port());
    EXPECT_NE(client->Upgrade(kHost, kOrigin).find(" 101 "), std::string::npos);
    return client;
  }
  static nlohmann::json Header(RawClient* client) {
    const std::optional<std::string> message = client->ReceiveMessage();
    return message ? DecodeFrame(*message).header : nlohmann::json{{"type", "none"}};
  }
  // A page that does this is closed with the status, and everybody else served as before.
  // may_be_lost: the server closes while bytes of ours are unread, which may take the close frame
  // with it.
  void ExpectClosed(RawClient* client, int status, bool may_be_lost = false) {
    while (client->ReceiveMessage()) {
    }
    if (!may_be_lost || client->close_status() != 0) {
      EXPECT_EQ(client->close_status(), status);
    }
    EXPECT_EQ(Header(Connect().get())["type"], "hello");
  }

  WebContent content_{R"({"type":"hello"})", {}};
  WebServer server_{AnyPort(), Page(), &content_, {}};
};

TEST_F(WebServerTest, ServesThePage) {
  RawClient client(server_.port());
  client.Send("GET /page.js HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const std::string head = client.ReceiveHead();
  EXPECT_EQ(head.substr(0, 15), "HTTP/1.1 200 OK");
  EXPECT_NE(head.find("content-security-policy: default-src 'none'"), std::string::npos);
  EXPECT_NE(head.find("content-length: 300000"), std::string::npos);
  EXPECT_EQ(client.Receive(300'000), std::string(300'000, 'x'));
}

TEST_F(WebServerTest, NothingButThePageIsServed) {
  for (const char* const path :
       {"/other", "/../other", "/page.js/", "/..%2f..%2fetc/passwd", "//etc/passwd"})
    EXPECT_EQ(Get(path, "Host: localhost\r\n").find("HTTP/1.1 200"), std::string::npos) << path;
}

TEST_F(WebServerTest, ForeignHostsAndOriginsAreRefused) {
  EXPECT_EQ(Get("/", "Host: localhost\r\n"), "HTTP/1.1 200 OK");
  EXPECT_NE(Get("/", "Host: example.org\r\n").find(" 403 "), std::string::npos);
  EXPECT_NE(Get("/", "Host: localhost\r\nOrigin: http://example.org\r\n").find(" 403 "),
            std::string::npos);
  EXPECT_EQ(Get("/", "").find(" 200 "), std::string::npos) << "without any host";
  EXPECT_GE(server_.counters().foreign_requests, 2);
}

TEST_F(WebServerTest, ForeignPagesGetNoWebSocket) {
  struct Case {
    const char* host;
    const char* origin;
    const char* answer;
  };
  for (const Case& c : {Case{kHost, kOrigin, " 101 "}, Case{kHost, "", " 101 "},
                        Case{kHost, "http://example.org", " 403 "}, Case{kHost, "null", " 403 "},
                        Case{kHost, "http://localhost:3000", " 403 "},
                        Case{"example.org:8086", "http://example.org:8086", " 403 "}}) {
    RawClient client(server_.port());
    const std::string status = client.Upgrade(c.host, c.origin);
    EXPECT_NE(status.find(c.answer), std::string::npos)
        << c.host << ", " << c.origin << ": " << status;
  }
}

TEST_F(WebServerTest, OnlyOurSubprotocolIsSpoken) {
  for (const char* const subprotocol : {"", "http", "other", "rimod-web, other"}) {
    RawClient client(server_.port());
    EXPECT_EQ(client.Upgrade(kHost, kOrigin, subprotocol).find(" 101 "), std::string::npos);
  }
}

TEST_F(WebServerTest, FramesComeOneByOneEachWhenTheLastIsShown) {
  content_.scans().SetScan(1, ScanOfPoints(150'000));
  const auto client = Connect();
  EXPECT_EQ(Header(client.get())["type"], "hello");
  content_.scans().SetScan(2, ScanOfPoints(150'000));
  client->SendFrame(kShown);
  const nlohmann::json scan = Header(client.get());
  EXPECT_EQ(scan["utime"], "2");
  EXPECT_EQ(scan["points"]["count"], 150'000);
  client->SendFrame(kShown);
  EXPECT_EQ(Header(client.get())["type"], "timeline");
}

TEST_F(WebServerTest, APageThatDoesNotReadHoldsNobodyUp) {
  const auto sleeper = Connect();
  sleeper->SendFrame(kShown);  // for hello, which it never reads; nor anything after
  const auto reader = Connect();
  EXPECT_EQ(Header(reader.get())["type"], "hello");
  std::string newest;
  for (int i = 1; i <= 40; ++i) {
    content_.scans().SetScan(i, ScanOfPoints(100'000));
    reader->SendFrame(kShown);
    const nlohmann::json header = Header(reader.get());
    if (header["type"] == "scan") newest = header["utime"];
  }
  EXPECT_GE(std::stoi(newest), 38);
}

TEST_F(WebServerTest, SoManyPagesAtATime) {
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 3; ++i) clients.push_back(Connect());
  ASSERT_TRUE(Eventually([&] { return server_.num_clients() == 3; }));
  RawClient another(server_.port());
  EXPECT_NE(another.Upgrade(kHost, kOrigin).find(" 503 "), std::string::npos);
  EXPECT_EQ(server_.counters().clients_too_many, 1);
  clients.pop_back();
  ASSERT_TRUE(Eventually([&] { return server_.num_clients() == 2; }));
  EXPECT_EQ(Header(Connect().get())["type"], "hello");
}

TEST_F(WebServerTest, AMessageThatIsNoRequestEndsItsConnection) {
  constexpr int kPolicyViolation = 1008;
  for (const char* const text : {"", "{", "[]", R"({"type":"nonsense"})", "\x01\x02"}) {
    const auto client = Connect();
    client->SendFrame(text);
    if (*text != '\0') ExpectClosed(client.get(), kPolicyViolation);
  }
  const auto binary = Connect();
  binary->SendFrame(kShown, 0x82);
  ExpectClosed(binary.get(), kPolicyViolation);
}

TEST_F(WebServerTest, AMessageThatIsTooLongEndsItsConnection) {
  constexpr int kTooLarge = 1009;
  const auto whole = Connect();
  whole->SendFrame(std::string(5'000'000, 'x'));
  while (whole->ReceiveMessage()) {
  }
  const auto parts = Connect();
  parts->SendFrame(std::string(100, 'x'), 0x01);
  for (int i = 0; i < 100; ++i) parts->SendFrame(std::string(100, 'x'), 0x00);
  ExpectClosed(parts.get(), kTooLarge, /*may_be_lost=*/true);
  EXPECT_TRUE(Eventually([&] { return server_.counters().bad_requests >= 2; }));
}

TEST_F(WebServerTest, AFloodEndsItsConnection) {
  const auto client = Connect();
  for (int i = 0; i < 20'000 && client->SendFrame(kShown); ++i) {
  }
  while (client->ReceiveMessage()) {
  }
  EXPECT_TRUE(Eventually([&] { return server_.num_clients() == 0; }));
  EXPECT_EQ(Header(Connect().get())["type"], "hello");
}

TEST_F(WebServerTest, GarbageAndHalfRequestsAreSurvived) {
  std::vector<std::unique_ptr<RawClient>> half;
  for (const char* const text :
       {"GET / HTT", "\x16\x03\x01\x02",
        "GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n",
        "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999\r\n\r\n", "\r\n\r\n\r\n",
        "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"}) {
    half.push_back(std::make_unique<RawClient>(server_.port()));
    half.back()->Send(text);
  }
  RawClient long_header(server_.port());
  long_header.Send("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(100'000, 'y'));
  EXPECT_EQ(Get("/", "Host: localhost\r\n"), "HTTP/1.1 200 OK");
  EXPECT_EQ(Header(Connect().get())["type"], "hello");
}

TEST_F(WebServerTest, APortInUseIsToldAtOnce) {
  WebServerOptions options = AnyPort();
  options.port = server_.port();
  WebContent content(R"({"type":"hello"})", {});
#ifdef __SANITIZE_ADDRESS__
  const __lsan::ScopedDisabler leaks_of_libwebsockets;  // of the listener that it could not make
#endif
  EXPECT_THROW(WebServer(options, Page(), &content, {}), std::runtime_error);
}

// The executable on a real bus, with a page of a line: it is not about the page.
class RimodWebTest : public testing::Test {
 protected:
  static constexpr int kPort = 18086;
  void SetUp() override { files_.Write("index.html", "<p>page</p>"); }
  std::unique_ptr<ChildProcess> Start(std::vector<std::string> words) {
    words.insert(words.begin(), std::string(RIMOD_BIN_DIR) + "/rimod-web");
    words.insert(words.end(), {"--page", files_.path(), "--port", std::to_string(kPort)});
    return std::make_unique<ChildProcess>(words, files_.PathOf("output"));
  }
  static std::unique_ptr<RawClient> Connect() {
    std::unique_ptr<RawClient> client;
    Eventually([&] {
      client = std::make_unique<RawClient>(kPort);
      return client->connected() &&
             client->Upgrade("127.0.0.1", "").find(" 101 ") != std::string::npos;
    });
    return client;
  }
  // The next frame of a type, all frames until then being shown.
  static nlohmann::json Await(RawClient* client, const std::string& type) {
    while (const std::optional<std::string> message = client->ReceiveMessage()) {
      const nlohmann::json header = DecodeFrame(*message).header;
      client->SendFrame(kShown);
      if (header["type"] == type) return header;
    }
    return {{"type", "none"}};
  }
  TemporaryFolder files_;
};

TEST_F(RimodWebTest, ShowsWhatIsOnTheBusAndTellsItsStatus) {
  const auto process = Start({});
  BusProbe bus;
  const auto client = Connect();
  EXPECT_EQ(Await(client.get(), "hello")["source"], "live");
  ASSERT_TRUE(bus.ListenUntil([&] { return bus.Status("rimod-web").has_value(); },
                              std::chrono::seconds(10)));
  StampedScan scan;
  scan.utime = 42;
  scan.utime_end = 43;
  scan.num_lines = 1;
  scan.scan = ScanOfPoints(20'000);
  bus.PublishAll("RIMOD_SCAN", ToSections(scan));
  EXPECT_EQ(Await(client.get(), "scan")["num_points"], 20'000);
  bus.Publish("RIMOD_DETECTIONS", std::vector<std::uint8_t>(40, 7));
  EXPECT_TRUE(bus.ListenUntil(
      [&] {
        const std::optional<status_t> status = bus.Status("rimod-web");
        return status && status->num_rejected == 1 && CounterOf(*status, "pages") == 1;
      },
      std::chrono::seconds(10)));
  process->Signal(SIGTERM);
  EXPECT_EQ(process->Wait(std::chrono::seconds(10)), 0) << process->Output();
}

TEST_F(RimodWebTest, PlaysALogAndStartsItAnew) {
  const auto process = Start({RIMOD_SOURCE_DIR "/logs/office.lcm", "--speed", "100"});
  const auto client = Connect();
  EXPECT_EQ(Await(client.get(), "hello")["source"], "log");
  EXPECT_GT(Await(client.get(), "scan")["num_points"], 100'000);
  nlohmann::json playback = Await(client.get(), "playback");
  while (playback["type"] == "playback" && !playback["at_end"])
    playback = Await(client.get(), "playback");
  EXPECT_EQ(playback["position"], playback["duration"]);
  client->SendFrame(R"({"type":"restart"})");
  EXPECT_GT(Await(client.get(), "scan")["num_points"], 100'000);
  process->Signal(SIGINT);
  EXPECT_EQ(process->Wait(std::chrono::seconds(10)), 0) << process->Output();
}

TEST_F(RimodWebTest, SaysWhatItCannotUse) {
  struct Case {
    std::vector<std::string> words;
    int exit_code;
    const char* text;
  };
  files_.Write("empty.lcm", "");
  for (const Case& c :
       {Case{{files_.PathOf("missing.lcm")}, 1, "missing.lcm"},
        Case{{files_.PathOf("empty.lcm")}, 1, "nothing that can be shown"},
        Case{{"--models", files_.PathOf("missing")}, 1, "missing"},
        Case{{"--address", "192.0.2.1"}, 1, "192.0.2.1"}, Case{{"--address", "robot"}, 1, "robot"},
        Case{{"--nonsense"}, 2, "nonsense"}, Case{{"--speed", "0"}, 2, "speed"},
        Case{{"--channel", "NO=X"}, 2, "NO"}}) {
    const auto process = Start(c.words);
    EXPECT_EQ(process->Wait(std::chrono::seconds(20)), c.exit_code) << c.text;
    EXPECT_NE(process->Output().find(c.text), std::string::npos) << process->Output();
  }
  std::filesystem::remove(files_.PathOf("index.html"));
  const auto process = Start({});
  EXPECT_EQ(process->Wait(std::chrono::seconds(20)), 1);
  EXPECT_NE(process->Output().find("index.html"), std::string::npos) << process->Output();
}

}  // namespace
}  // namespace rimod
