#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rimod {

enum class ByteOrder { kLittle, kBig };

// How a number is stored in a binary file.
struct NumberFormat {
  enum class Kind { kSigned, kUnsigned, kFloat };
  Kind kind = Kind::kFloat;
  int size = 4;  // bytes: 1, 2, 4, 8; of floats 4, 8
};

// The number at these bytes, of which there must be format.size. 64-bit integers are rounded.
double ReadNumber(const char* bytes, const NumberFormat& format, ByteOrder order);

// The number that the whole text is, "nan" and "inf" included, whatever the locale.
std::optional<double> ParseNumber(std::string_view text);

// The same for integers from 0 to INT64_MAX.
std::optional<std::int64_t> ParseCount(std::string_view text);

// The words of a text, separated by blanks and tabs.
std::vector<std::string_view> SplitWords(std::string_view text);

// Walks over the lines or words of a text.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text) : text_(text) {}

  // The next line without its end ("\n" or "\r\n"); nothing after the last.
  std::optional<std::string_view> NextLine();
  // The next word, over line ends; nothing after the last.
  std::optional<std::string_view> NextWord();

  std::size_t position() const { return position_; }
  // Of the last line that NextLine() gave, from 1.
  std::int64_t line_number() const { return line_number_; }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  std::int64_t line_number_ = 0;
};

}  // namespace rimod
