#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace rimod {

// Throws std::invalid_argument naming the parameter and its value unless min <= value <= max; a NaN
// is never within.
template <typename T>
void CheckWithin(const std::string& name, T value, T min, T max) {
  if (value >= min && value <= max) return;
  std::ostringstream text;
  text << name << " is " << value << ", not within " << min << " .. " << max;
  throw std::invalid_argument(text.str());
}

}  // namespace rimod
