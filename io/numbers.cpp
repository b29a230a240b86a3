#include "io/numbers.h"

#include <charconv>
#include <cstring>

namespace rimod {
namespace {

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

}  // namespace

double ReadNumber(const char* bytes, const NumberFormat& format, ByteOrder order) {
  std::uint64_t bits = 0;
  for (int i = 0; i < format.size; ++i) {
    const int byte = order == ByteOrder::kLittle ? format.size - 1 - i : i;
    bits = (bits << 8) | static_cast<unsigned char>(bytes[byte]);
  }
  if (format.kind == NumberFormat::Kind::kUnsigned) return static_cast<double>(bits);
  if (format.kind == NumberFormat::Kind::kSigned) {
    const int unused = 64 - 8 * format.size;  // shifted up and down again to carry the sign
    return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
  }
  if (format.size == 4) {
    const auto half = static_cast<std::uint32_t>(bits);
    float value = 0.0f;
    std::memcpy(&value, &half, sizeof value);
    return static_cast<double>(value);
  }
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::optional<double> ParseNumber(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const std::from_chars_result result =
      std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ptr != text.data() + text.size() || text.empty()) return std::nullopt;
  // Too large or too small for a double: neither is a coordinate.
  if (result.ec == std::errc::result_out_of_range) return 0.0;
  if (result.ec != std::errc()) return std::nullopt;
  return value;
}

std::optional<std::int64_t> ParseCount(std::string_view text) {
  std::int64_t value = 0;
  const std::from_chars_result result =
      std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return std::nullopt;
  if (value < 0) return std::nullopt;
  return value;
}

std::vector<std::string_view> SplitWords(std::string_view text) {
  std::vector<std::string_view> words;
  TextCursor cursor(text);
  while (const std::optional<std::string_view> word = cursor.NextWord()) words.push_back(*word);
  return words;
}

std::optional<std::string_view> TextCursor::NextLine() {
  if (position_ >= text_.size()) return std::nullopt;
  const std::size_t end = std::min(text_.find('\n', position_), text_.size());
  std::string_view line = text_.substr(position_, end - position_);
  position_ = std::min(end + 1, text_.size());
  ++line_number_;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::optional<std::string_view> TextCursor::NextWord() {
  while (position_ < text_.size() && IsBlank(text_[position_])) ++position_;
  if (position_ >= text_.size()) return std::nullopt;
  const std::size_t begin = position_;
  while (position_ < text_.size() && !IsBlank(text_[position_])) ++position_;
  return text_.substr(begin, position_ - begin);
}

}  // namespace rimod
