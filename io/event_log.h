#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rimod {

// One message in a log of lcm-logger.
struct LogEvent {
  std::int64_t number = 0;  // counts the events of a log from 0
  std::int64_t utime = 0;   // us, wall clock of the logger when it came in
  std::string channel;
  std::vector<std::uint8_t> bytes;  // the encoded message
};

// True when the file begins like a log of lcm-logger (their names have no ending). An empty file is
// none.
bool IsEventLog(const std::string& path);

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FilePointer = std::unique_ptr<std::FILE, FileCloser>;

// Reads a log of lcm-logger. Damaged parts are skipped up to the next event, a truncated end is
// left out; both are told by error() while every whole event is delivered.
class EventLogReader {
 public:
  // A file that cannot be opened or is no log gives no events and an error().
  explicit EventLogReader(const std::string& path);

  // The next whole event; nothing at the end.
  std::optional<LogEvent> Next();

  // What was wrong so far: names the file, the place and the cause; empty when all was well.
  const std::string& error() const { return error_; }
  std::int64_t num_events() const { return num_events_; }

 private:
  bool FindEvent();
  void Complain(const std::string& cause);

  std::string path_;
  FilePointer file_;
  std::int64_t size_ = 0;      // bytes of the file
  std::int64_t position_ = 0;  // of the next event
  std::int64_t num_events_ = 0;
  std::string error_;
};

// Writes a log as lcm-logger does, under a temporary name until Close().
class EventLogWriter {
 public:
  explicit EventLogWriter(const std::string& path);
  ~EventLogWriter();  // an unclosed log is removed
  EventLogWriter(const EventLogWriter&) = delete;
  EventLogWriter& operator=(const EventLogWriter&) = delete;

  // utime in us. A failure shows in Close().
  void Write(std::int64_t utime, const std::string& channel, const void* bytes, std::size_t size);

  // Flushes to the disk and gives the log its name. Returns an error text, empty when done.
  std::string Close();

 private:
  std::string path_;
  std::string temporary_;
  FilePointer file_;
  std::int64_t num_events_ = 0;
  std::string error_;
};

}  // namespace rimod
