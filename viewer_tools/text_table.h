#pragma once

#include <string>
#include <vector>

namespace rimod {

using TextRow = std::vector<std::string>;

// Rows as lines, columns as wide as their widest entry: the first flush left, the others flush
// right, two blanks before each.
std::string FormatRows(const std::vector<TextRow>& rows);

// A number with so many decimals; never "-0.0".
std::string FormatNumber(double value, int decimals);

// A text from a message, cut to 64 characters, with '?' for what is not printable ASCII: messages
// may come from anyone, and nothing of them may steer the terminal.
std::string Printable(const std::string& text);

}  // namespace rimod
