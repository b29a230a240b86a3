#pragma once

#include <string>

#include "io/config_table.h"

namespace rimod {

// Sets what the key points to from a value as a configuration file has it; angles in degrees.
// Returns what was expected, "a whole number", empty when it was that. Ranges are not checked.
std::string SetConfigValue(const ConfigKey& key, const std::string& text);

// The value as a configuration file has it: the shortest text that SetConfigValue reads as the same
// value.
std::string ConfigValueText(const ConfigKey& key);

}  // namespace rimod
