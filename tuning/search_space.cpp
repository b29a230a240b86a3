#include "tuning/search_space.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "io/numbers.h"

namespace rimod {

bool Dimension::logarithmic() const {
  constexpr double kFarApart = 2.5;  // times
  return low > 0.0 && high >= kFarApart * low;
}

std::string Dimension::ValueAt(double place) const {
  const double share = std::clamp(place, 0.0, 1.0);
  if (!values.empty()) {
    const double index = std::floor(share * static_cast<double>(values.size()));
    return values[std::min(values.size() - 1, static_cast<std::size_t>(index))];
  }
  if (whole && !logarithmic()) {
    const double index = std::floor(share * (high - low + 1.0));
    return std::to_string(std::llround(std::min(low + index, high)));
  }
  const double value =
      logarithmic() ? low * std::pow(high / low, share) : low + share * (high - low);
  if (whole) return std::to_string(std::llround(std::clamp(value, low, high)));
  const std::string text = RoundedNumberText(value);
  const double rounded = ParseNumber(text).value_or(value);
  return rounded < low || rounded > high ? RoundedNumberText(rounded < low ? low : high) : text;
}

double Dimension::PlaceOf(const std::string& value) const {
  constexpr double kUnknown = 0.5;
  if (!values.empty()) {
    const auto found = std::find(values.begin(), values.end(), value);
    if (found == values.end()) return kUnknown;
    return (static_cast<double>(found - values.begin()) + 0.5) / static_cast<double>(values.size());
  }
  const std::optional<double> number = ParseNumber(value);
  if (!number || std::isnan(*number)) return kUnknown;
  const double inside = std::clamp(*number, low, high);
  if (logarithmic()) return std::log(inside / low) / std::log(high / low);
  return whole ? (inside - low + 0.5) / (high - low + 1.0) : (inside - low) / (high - low);
}

double Dimension::SmallestStep() const {
  if (!values.empty()) return 1.0 / static_cast<double>(values.size());
  if (!whole) return 0.0;
  return logarithmic() ? 0.0 : 1.0 / (high - low + 1.0);
}

std::optional<VaryText> ParseVaryText(const std::string& text) {
  VaryText vary;
  const std::size_t equals = text.find('=');
  vary.name = text.substr(0, equals);
  if (vary.name.empty()) return std::nullopt;
  if (equals == std::string::npos) return vary;
  const std::string given = text.substr(equals + 1);
  const std::size_t dots = given.find("..");
  if (dots != std::string::npos) {
    vary.low = given.substr(0, dots);
    vary.high = given.substr(dots + 2);
    return vary.low->empty() || vary.high->empty() ? std::nullopt : std::optional(vary);
  }
  for (std::size_t begin = 0; begin <= given.size();) {
    const std::size_t end = std::min(given.find(',', begin), given.size());
    if (end == begin) return std::nullopt;
    vary.values.push_back(given.substr(begin, end - begin));
    begin = end + 1;
  }
  return vary;
}

std::string RoundedNumberText(double value) {
  constexpr int kDigits = 3;
  char text[64];
  const std::to_chars_result end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, kDigits);
  return std::string(text, end.ptr);
}

}  // namespace rimod
