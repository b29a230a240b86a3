#include "io/event_log.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "io/files.h"

namespace rimod {
namespace {

// An event: magic, number (8 bytes), utime (8), length of the channel (4), of the message (4), all
// big-endian, then channel and message.
constexpr std::uint32_t kMagic = 0xEDA1DA01;
constexpr std::int64_t kHeaderBytes = 28;
constexpr std::int64_t kMaxChannelBytes = 255;  // LCM's limit is 63
constexpr std::int64_t kMaxEventBytes = 256'000'000;

std::uint64_t ReadBigEndian(const std::uint8_t* bytes, int size) {
  std::uint64_t value = 0;
  for (int i = 0; i < size; ++i) value = (value << 8) | bytes[i];
  return value;
}

void AppendBigEndian(std::uint64_t value, int size, std::vector<std::uint8_t>* bytes) {
  for (int i = size - 1; i >= 0; --i) {
    bytes->push_back(static_cast<std::uint8_t>((value >> (8 * i)) & 0xff));
  }
}

struct EventHeader {
  std::int64_t number = 0;
  std::int64_t utime = 0;
  std::int64_t channel_bytes = 0;
  std::int64_t message_bytes = 0;

  std::int64_t event_bytes() const { return kHeaderBytes + channel_bytes + message_bytes; }
};

// Nothing when these kHeaderBytes bytes begin no event.
std::optional<EventHeader> ParseHeader(const std::uint8_t* bytes) {
  if (ReadBigEndian(bytes, 4) != kMagic) return std::nullopt;
  EventHeader header;
  header.number = static_cast<std::int64_t>(ReadBigEndian(bytes + 4, 8));
  header.utime = static_cast<std::int64_t>(ReadBigEndian(bytes + 12, 8));
  header.channel_bytes = static_cast<std::int64_t>(ReadBigEndian(bytes + 20, 4));
  header.message_bytes = static_cast<std::int64_t>(ReadBigEndian(bytes + 24, 4));
  const bool plausible = header.channel_bytes >= 1 && header.channel_bytes <= kMaxChannelBytes &&
                         header.message_bytes <= kMaxEventBytes;
  return plausible ? std::optional<EventHeader>(header) : std::nullopt;
}

}  // namespace

bool IsEventLog(const std::string& path) {
  const std::string start = ReadFileStart(path, 4);
  return start.size() == 4 &&
         ReadBigEndian(reinterpret_cast<const std::uint8_t*>(start.data()), 4) == kMagic;
}

EventLogReader::EventLogReader(const std::string& path) : path_(path) {
  if (!IsEventLog(path)) {
    const FileBytes file = ReadFile(path, 0);  // tells why when it cannot be read at all
    const bool unreadable = !file.bytes && ReadFileStart(path, 1).empty();
    error_ = unreadable   ? file.error
             : file.bytes ? path + ": is empty, not an LCM log"
                          : path + ": is not an LCM log";
    return;
  }
  file_.reset(std::fopen(path.c_str(), "rb"));
  if (!file_ || ::fseeko(file_.get(), 0, SEEK_END) != 0) {
    error_ = path + ": cannot be read: " + std::strerror(errno);
    file_.reset();
    return;
  }
  size_ = ::ftello(file_.get());
}

void EventLogReader::Complain(const std::string& cause) {
  if (error_.empty()) error_ = path_ + ": " + cause;  // the first damage; later ones often follow
}

std::optional<LogEvent> EventLogReader::Next() {
  while (file_ && position_ < size_) {
    std::uint8_t bytes[kHeaderBytes] = {};
    ::fseeko(file_.get(), position_, SEEK_SET);
    const std::size_t num_read = std::fread(bytes, 1, sizeof bytes, file_.get());
    const std::optional<EventHeader> header =
        num_read == sizeof bytes ? ParseHeader(bytes) : std::nullopt;
    const bool fits = header && position_ + header->event_bytes() <= size_;
    if (!fits) {
      if (!FindEvent()) return std::nullopt;
      continue;
    }
    LogEvent event;
    event.number = header->number;
    event.utime = header->utime;
    event.channel.resize(static_cast<std::size_t>(header->channel_bytes));
    event.bytes.resize(static_cast<std::size_t>(header->message_bytes));
    if (std::fread(event.channel.data(), 1, event.channel.size(), file_.get()) !=
            event.channel.size() ||
        std::fread(event.bytes.data(), 1, event.bytes.size(), file_.get()) != event.bytes.size()) {
      Complain("reading failed at byte " + std::to_string(position_));
      break;
    }
    position_ += header->event_bytes();
    ++num_events_;
    return event;
  }
  file_.reset();
  return std::nullopt;
}

// Moves position_ past the damage there to the next magic number; false when there is none.
bool EventLogReader::FindEvent() {
  const std::int64_t damage = position_;
  constexpr std::int64_t kBlock = 1 << 20;
  std::vector<std::uint8_t> block;
  for (std::int64_t begin = damage + 1; begin + 4 <= size_; begin += kBlock - 3) {
    block.resize(static_cast<std::size_t>(std::min(kBlock, size_ - begin)));
    ::fseeko(file_.get(), begin, SEEK_SET);
    block.resize(std::fread(block.data(), 1, block.size(), file_.get()));
    for (std::size_t i = 0; i + 4 <= block.size(); ++i) {
      if (ReadBigEndian(block.data() + i, 4) != kMagic) continue;
      position_ = begin + static_cast<std::int64_t>(i);
      Complain("damaged at byte " + std::to_string(damage) + ", left out " +
               std::to_string(position_ - damage) + " bytes");
      return true;
    }
  }
  Complain("is truncated or damaged at byte " + std::to_string(damage) + " after " +
           std::to_string(num_events_) + " events");
  position_ = size_;
  file_.reset();
  return false;
}

EventLogWriter::EventLogWriter(const std::string& path) : path_(path) {
  temporary_ = path + ".XXXXXX";
  const int descriptor = ::mkstemp(temporary_.data());
  if (descriptor >= 0) file_.reset(::fdopen(descriptor, "wb"));
  if (!file_) error_ = path + ": cannot be written: " + std::strerror(errno);
}

EventLogWriter::~EventLogWriter() {
  if (!file_) return;
  file_.reset();
  ::unlink(temporary_.c_str());
}

void EventLogWriter::Write(std::int64_t utime, const std::string& channel, const void* bytes,
                           std::size_t size) {
  if (!file_ || !error_.empty()) return;
  if (channel.empty() || channel.size() > kMaxChannelBytes ||
      size > static_cast<std::size_t>(kMaxEventBytes)) {
    error_ = path_ + ": an event on channel '" + channel.substr(0, 80) + "' cannot be written";
    return;
  }
  std::vector<std::uint8_t> event;
  AppendBigEndian(kMagic, 4, &event);
  AppendBigEndian(static_cast<std::uint64_t>(num_events_), 8, &event);
  AppendBigEndian(static_cast<std::uint64_t>(utime), 8, &event);
  AppendBigEndian(channel.size(), 4, &event);
  AppendBigEndian(size, 4, &event);
  event.insert(event.end(), channel.begin(), channel.end());
  const bool written = std::fwrite(event.data(), 1, event.size(), file_.get()) == event.size() &&
                       (size == 0 || std::fwrite(bytes, 1, size, file_.get()) == size);
  if (!written) error_ = path_ + ": writing failed: " + std::strerror(errno);
  ++num_events_;
}

std::string EventLogWriter::Close() {
  if (!file_) return error_.empty() ? path_ + ": is closed already" : error_;
  constexpr mode_t kReadableByAll = 0644;  // mkstemp gives 0600
  const bool flushed = std::fflush(file_.get()) == 0 && ::fsync(::fileno(file_.get())) == 0 &&
                       ::fchmod(::fileno(file_.get()), kReadableByAll) == 0;
  if (!flushed && error_.empty()) error_ = path_ + ": writing failed: " + std::strerror(errno);
  file_.reset();
  if (error_.empty() && std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    error_ = path_ + ": cannot be written: " + std::strerror(errno);
  }
  if (!error_.empty()) ::unlink(temporary_.c_str());
  return error_;
}

}  // namespace rimod
