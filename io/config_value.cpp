#include "io/config_value.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "io/numbers.h"

namespace rimod {
namespace {

constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180.0;

std::optional<double> FiniteNumber(const std::string& text) {
  const std::optional<double> number = ParseNumber(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<int> WholeNumber(const std::string& text) {
  int value = 0;
  const char* const end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

// Sets the key's value from the file's text. Each returns what was expected, empty when it was
// that.
struct Setter {
  const std::string& text;

  std::string operator()(double* value) const {
    const std::optional<double> number = FiniteNumber(text);
    if (number) *value = *number;
    return number ? "" : "a number";
  }
  std::string operator()(const DegreesOf& value) const {
    const std::optional<double> degrees = FiniteNumber(text);
    if (degrees) *value.radians = *degrees * kRadiansPerDegree;
    return degrees ? "" : "a number of degrees";
  }
  std::string operator()(int* value) const {
    const std::optional<int> number = WholeNumber(text);
    if (number) *value = *number;
    return number ? "" : "a whole number";
  }
  std::string operator()(bool* value) const {
    if (text != "true" && text != "false") return "true or false";
    *value = text == "true";
    return "";
  }
  std::string operator()(const ChoiceOf& value) const {
    std::string names;
    for (std::size_t i = 0; i < value.names.size(); ++i) {
      if (text == value.names[i]) {
        value.set(static_cast<int>(i));
        return "";
      }
      names += (i == 0 ? "" : " or ") + value.names[i];
    }
    return names;
  }
};

// Shortest text that reads as the same number.
std::string NumberText(double value) {
  char text[64];
  const std::to_chars_result end = std::to_chars(text, text + sizeof text, value);
  return std::string(text, end.ptr);
}

// Shortest text in degrees that reads as the same radians, or the nearest where there is none.
std::string DegreesText(double radians) {
  const double degrees = radians / kRadiansPerDegree;
  for (int digits = 1; digits <= std::numeric_limits<double>::max_digits10; ++digits) {
    char text[64];
    const std::to_chars_result end =
        std::to_chars(text, text + sizeof text, degrees, std::chars_format::general, digits);
    const std::string candidate(text, end.ptr);
    if (ParseNumber(candidate).value_or(0.0) * kRadiansPerDegree == radians) return candidate;
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double towards : {-kInfinity, kInfinity}) {
    const double neighbour = std::nextafter(degrees, towards);
    if (neighbour * kRadiansPerDegree == radians) return NumberText(neighbour);
  }
  return NumberText(degrees);
}

struct Printer {
  std::string operator()(const double* value) const { return NumberText(*value); }
  std::string operator()(const DegreesOf& value) const { return DegreesText(*value.radians); }
  std::string operator()(const int* value) const { return std::to_string(*value); }
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const ChoiceOf& value) const {
    return value.names[static_cast<std::size_t>(value.get())];
  }
};

}  // namespace

std::string SetConfigValue(const ConfigKey& key, const std::string& text) {
  return std::visit(Setter{text}, key.value);
}

std::string ConfigValueText(const ConfigKey& key) { return std::visit(Printer(), key.value); }

}  // namespace rimod
