#include "web_viewer/client_session.h"

#include <gtest/gtest.h>

#include "tests/web_viewer/decoded_frame.h"

namespace rimod {
namespace {

class ClientSessionTest : public testing::Test {
 protected:
  static std::map<std::string, Frame> Models() {
    return {{"fan", MakeFrame(R"({"type":"model","name":"fan"})")}};
  }

  void AddScan(std::int64_t utime) {
    Scan scan;
    scan.points.assign(10, Eigen::Vector3f(1.0f, 0.0f, 0.0f));
    content_.scans().SetScan(utime, scan);
  }
  void AddDetections(std::int64_t utime) {
    StampedDetections detections;
    detections.utime = utime;
    content_.scans().SetDetections(detections);
  }

  void Ask(const std::string& request) { session_.Take(*ParseClientRequest(request)); }
  // The type of the next frame, and of which scan; "-" when none comes.
  std::string Next() {
    const std::optional<Frame> frame = session_.Next();
    if (!frame) return "-";
    const nlohmann::json header = DecodeFrame(**frame).header;
    return header["type"].get<std::string>() + " " + header.value("utime", "");
  }
  std::string NextAfterShown() {
    Ask(R"({"type":"shown"})");
    return Next();
  }
  // Everything that comes until nothing more does, each shown at once.
  std::vector<std::string> Rest() {
    std::vector<std::string> frames;
    for (std::string frame = NextAfterShown(); frame != "-"; frame = NextAfterShown())
      frames.push_back(frame);
    return frames;
  }

  WebContent content_{R"({"type":"hello"})", Models()};
  ClientSession session_{&content_};
};

TEST_F(ClientSessionTest, GreetsFirst) {
  AddScan(1);
  EXPECT_EQ(Next(), "hello ");
}

TEST_F(ClientSessionTest, NothingComesUntilTheLastFrameIsShown) {
  AddScan(1);
  EXPECT_EQ(Next(), "hello ");
  AddScan(2);
  EXPECT_EQ(Next(), "-");
  EXPECT_EQ(NextAfterShown(), "scan 2");
  EXPECT_EQ(Next(), "-");
}

TEST_F(ClientSessionTest, ASlowPageGetsTheNewestScanOnly) {
  AddScan(1);
  Next();
  NextAfterShown();
  for (int i = 2; i < 50; ++i) AddScan(i);
  const std::vector<std::string> rest = Rest();
  EXPECT_EQ(std::count(rest.begin(), rest.end(), "scan 49"), 1);
  EXPECT_EQ(rest.size(), 2U) << "the scan and the timeline";
}

TEST_F(ClientSessionTest, ScansThatComeFastDoNotKeepTheOthersBack) {
  AddScan(1);
  Next();
  Ask(R"({"type":"model","name":"fan"})");
  std::vector<std::string> types;
  for (int i = 2; i < 12; ++i) {
    AddScan(i);
    AddDetections(i);
    const std::string frame = NextAfterShown();
    types.push_back(frame.substr(0, frame.find(' ')));
  }
  for (const char* const type : {"scan", "objects", "timeline", "model"})
    EXPECT_GE(std::count(types.begin(), types.end(), type), 1) << type;
}

TEST_F(ClientSessionTest, TheSameIsNotSentTwice) {
  AddScan(1);
  AddDetections(1);
  Next();
  EXPECT_EQ(Rest(), (std::vector<std::string>{"scan 1", "objects 1", "timeline "}));
  EXPECT_TRUE(Rest().empty());
  AddDetections(1);
  EXPECT_EQ(Rest(), (std::vector<std::string>{"objects 1", "timeline "}));
}

TEST_F(ClientSessionTest, AChosenScanStaysWhileOthersCome) {
  AddScan(1);
  AddScan(2);
  Next();
  Rest();
  Ask(R"({"type":"choose","id":1})");
  EXPECT_EQ(Rest(), (std::vector<std::string>{"scan 1"}));
  AddScan(3);
  EXPECT_EQ(Rest(), (std::vector<std::string>{"timeline "}));
  Ask(R"({"type":"follow"})");
  EXPECT_EQ(Rest(), (std::vector<std::string>{"scan 3"}));
}

TEST_F(ClientSessionTest, AChosenScanThatIsForgottenGivesWayToTheNewest) {
  AddScan(1);
  AddScan(2);
  Next();
  Ask(R"({"type":"choose","id":1})");
  Rest();
  for (int i = 3; i < 200; ++i) AddScan(i);
  EXPECT_EQ(NextAfterShown(), "scan 199");
}

TEST_F(ClientSessionTest, UnknownIdsAndModelsChangeNothing) {
  AddScan(1);
  Next();
  Rest();
  Ask(R"({"type":"choose","id":77})");
  Ask(R"({"type":"choose","id":-9223372036854775808})");
  Ask(R"({"type":"model","name":"unknown"})");
  EXPECT_TRUE(Rest().empty());
}

TEST_F(ClientSessionTest, AModelComesOnceForEachTimeThatItIsWanted) {
  Next();
  for (int i = 0; i < 100; ++i) Ask(R"({"type":"model","name":"fan"})");
  const std::vector<std::string> rest = Rest();
  EXPECT_EQ(std::count(rest.begin(), rest.end(), "model "), 1);
}

TEST_F(ClientSessionTest, TellsWhereTheLogIs) {
  Next();
  Rest();
  Playback playback;
  playback.position = 3.0;
  content_.SetPlayback(playback);
  EXPECT_EQ(Rest(), (std::vector<std::string>{"playback "}));
}

}  // namespace
}  // namespace rimod
