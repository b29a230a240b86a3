#include "viewer_tools/text_table.h"

#include <algorithm>
#include <cstdio>

namespace rimod {

std::string FormatNumber(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", decimals, value);
  // No "-0.00": nobody asks on which side of zero a rounded number was.
  const bool is_zero = std::string(text).find_first_of("123456789") == std::string::npos;
  return is_zero && text[0] == '-' ? text + 1 : text;
}

std::string Printable(const std::string& text) {
  constexpr std::size_t kMaxLength = 64;
  std::string printable = text.substr(0, kMaxLength);
  for (char& c : printable)
    if (c < ' ' || c > '~') c = '?';
  return printable;
}

std::string FormatRows(const std::vector<TextRow>& rows) {
  std::vector<std::size_t> widths;
  for (const TextRow& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const TextRow& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - row[i].size(), ' ');
      const bool last = i + 1 == row.size();
      text += i == 0 ? "  " + row[i] + (last ? "" : padding) : "  " + padding + row[i];
    }
    text += '\n';
  }
  return text;
}

}  // namespace rimod
