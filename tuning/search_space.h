#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rimod {

// One value for each dimension, as a configuration file has them.
using Setting = std::vector<std::string>;

// A parameter that is varied: numbers of a range, or values of a list.
struct Dimension {
  std::string name;                 // "section.key"
  std::vector<std::string> values;  // a list; empty: the range
  double low = 0.0, high = 0.0;     // low < high
  bool whole = false;               // whole numbers only

  // Ranges whose ends are far apart are varied by factors, others by differences.
  bool logarithmic() const;
  // The value at a place, 0 .. 1; of a range rounded to three significant digits, within its ends.
  std::string ValueAt(double place) const;
  // Where ValueAt gives this value, as near as there is one; 0.5 for what is no value.
  double PlaceOf(const std::string& value) const;
  // The smallest step that gives another value: of a list or of whole numbers; else 0.
  double SmallestStep() const;
};

// A parameter as a user names it: "section.key", "section.key=LOW..HIGH" or "section.key=A,B,C".
struct VaryText {
  std::string name;
  std::vector<std::string> values;       // of a list
  std::optional<std::string> low, high;  // of a range
};

// Nothing for text of another form: no name, an empty value.
std::optional<VaryText> ParseVaryText(const std::string& text);

// The value with three significant digits: finer steps are below what scans can tell.
std::string RoundedNumberText(double value);

}  // namespace rimod
