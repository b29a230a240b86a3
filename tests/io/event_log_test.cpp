#include "io/event_log.h"

#include <gtest/gtest.h>

#include <lcm/lcm-cpp.hpp>

#include "tests/io/random_values.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_matchers.h"

namespace rimod {
namespace {

std::vector<LogEvent> ReadAll(EventLogReader* log) {
  std::vector<LogEvent> events;
  while (std::optional<LogEvent> event = log->Next()) events.push_back(std::move(*event));
  return events;
}

std::vector<LogEvent> SomeEvents(int count) {
  RandomValues random(4);
  std::vector<LogEvent> events;
  for (int i = 0; i < count; ++i) {
    LogEvent event;
    event.number = i;
    event.utime = 1'000'000'000'000 + i;
    event.channel = i % 3 == 0 ? "LASER" : "OTHER_CHANNEL";
    for (int size = random.Int(0, 300); size > 0; --size) {
      event.bytes.push_back(static_cast<std::uint8_t>(random.Int(0, 255)));
    }
    events.push_back(std::move(event));
  }
  return events;
}

std::string WriteLog(const TemporaryFolder& folder, const std::vector<LogEvent>& events) {
  EventLogWriter writer(folder.PathOf("log"));
  for (const LogEvent& event : events) {
    writer.Write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
  }
  EXPECT_EQ(writer.Close(), "");
  return folder.PathOf("log");
}

bool Equal(const LogEvent& a, const LogEvent& b) {
  return a.number == b.number && a.utime == b.utime && a.channel == b.channel && a.bytes == b.bytes;
}

TEST(EventLogTest, WrittenEventsAreReadBack) {
  const TemporaryFolder folder;
  const std::vector<LogEvent> events = SomeEvents(50);
  EventLogReader log(WriteLog(folder, events));
  const std::vector<LogEvent> read = ReadAll(&log);
  EXPECT_EQ(log.error(), "");
  EXPECT_TRUE(std::equal(events.begin(), events.end(), read.begin(), read.end(), Equal));
}

TEST(EventLogTest, LcmReadsWhatWeWriteAndWeWhatItWrites) {
  const TemporaryFolder folder;
  const std::vector<LogEvent> events = SomeEvents(20);
  lcm::LogFile ours(WriteLog(folder, events), "r");
  ASSERT_TRUE(ours.good());
  auto theirs = std::make_unique<lcm::LogFile>(folder.PathOf("theirs"), "w");
  for (const LogEvent& event : events) {
    const lcm::LogEvent* const read = ours.readNextEvent();
    ASSERT_NE(read, nullptr);
    EXPECT_EQ(read->channel, event.channel);
    EXPECT_EQ(read->timestamp, event.utime);
    EXPECT_EQ(read->datalen, static_cast<int>(event.bytes.size()));
    lcm::LogEvent copy = *read;
    EXPECT_EQ(theirs->writeEvent(&copy), 0);
  }
  EXPECT_EQ(ours.readNextEvent(), nullptr);
  theirs.reset();  // closes it
  EventLogReader log(folder.PathOf("theirs"));
  const std::vector<LogEvent> read = ReadAll(&log);
  EXPECT_TRUE(std::equal(events.begin(), events.end(), read.begin(), read.end(), Equal));
}

TEST(EventLogTest, EventsBeforeATruncatedOneAreUsed) {
  const TemporaryFolder folder;
  const std::vector<LogEvent> events = SomeEvents(10);
  WriteLog(folder, events);
  const std::string bytes = folder.Read("log");
  const std::size_t last = 28 + events.back().channel.size() + events.back().bytes.size();
  for (std::size_t cut = 1; cut < last; cut += 7) {
    folder.Write("cut", bytes.substr(0, bytes.size() - cut));
    EventLogReader log(folder.PathOf("cut"));
    EXPECT_EQ(ReadAll(&log).size(), 9u) << cut;
    EXPECT_TRUE(Mentions(log.error(), {"cut", "truncated", "after 9 events"}));
  }
}

TEST(EventLogTest, EventsAfterDamageAreUsed) {
  const TemporaryFolder folder;
  const std::vector<LogEvent> events = SomeEvents(10);
  WriteLog(folder, events);
  std::string bytes = folder.Read("log");
  const std::size_t second = 28 + events[0].channel.size() + events[0].bytes.size();
  bytes[second] = 'x';  // its magic number
  folder.Write("damaged", bytes);
  EventLogReader log(folder.PathOf("damaged"));
  const std::vector<LogEvent> read = ReadAll(&log);
  ASSERT_EQ(read.size(), 9u);
  EXPECT_TRUE(Equal(read[1], events[2]));
  EXPECT_TRUE(Mentions(log.error(), {"damaged", "byte " + std::to_string(second)}));
}

TEST(EventLogTest, AbsurdLengthsAreDamage) {
  const TemporaryFolder folder;
  WriteLog(folder, SomeEvents(1));
  const std::string good = folder.Read("log");
  for (const std::size_t at : {20u, 24u}) {  // length of the channel, of the message
    for (const char* length : {"\x7f\xff\xff\xff", "\xff\xff\xff\xff", "\x80\x00\x00\x01"}) {
      std::string bytes = good;
      bytes.replace(at, 4, std::string(length, 4));
      folder.Write("bad", bytes + good);
      EventLogReader log(folder.PathOf("bad"));
      EXPECT_EQ(ReadAll(&log).size(), 1u);
      EXPECT_TRUE(Mentions(log.error(), {"bad", "damaged at byte 0"}));
    }
  }
}

TEST(EventLogTest, OtherFilesAreNoLogs) {
  const TemporaryFolder folder;
  for (const std::string& path :
       {folder.Write("empty", ""), folder.Write("text", "Hello"), folder.Write("short", "\xed\xa1"),
        folder.PathOf("none"), folder.path()}) {
    EXPECT_FALSE(IsEventLog(path)) << path;
    EventLogReader log(path);
    EXPECT_FALSE(log.Next());
    EXPECT_TRUE(Mentions(log.error(), {path}));
  }
}

TEST(EventLogTest, UnclosedLogsLeaveNothing) {
  const TemporaryFolder folder;
  {
    EventLogWriter writer(folder.PathOf("log"));
    writer.Write(0, "LASER", "x", 1);
    EXPECT_EQ(folder.Names().size(), 1u);  // the temporary one
  }
  EXPECT_EQ(folder.Names().size(), 0u);
  EventLogWriter nowhere(folder.PathOf("no/log"));
  nowhere.Write(0, "LASER", "x", 1);
  EXPECT_TRUE(Mentions(nowhere.Close(), {"no/log"}));
}

}  // namespace
}  // namespace rimod
