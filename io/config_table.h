#pragma once

#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "io/config.h"

namespace rimod {

// An angle: radians in the struct, degrees in the file; its key ends in `_deg`.
struct DegreesOf {
  double* radians = nullptr;
};

// One of several names, the number of the name counted from 0.
struct ChoiceOf {
  std::vector<std::string> names;
  std::function<int()> get;
  std::function<void(int)> set;
};

// A key of the configuration: where it stands in the file and in the structs.
struct ConfigKey {
  std::string section;  // empty: top level
  std::string key;
  std::variant<double*, DegreesOf, int*, bool*, ChoiceOf> value;
  std::string comment;  // meaning, unit and range, for people; one line
};

// Every key there is, sections in the order of the pipeline, keys of a section together; values
// point into the given configuration.
std::vector<ConfigKey> ConfigTable(Configuration* configuration);

// Each section's check; throws std::invalid_argument "FIELD is VALUE, ...".
using SectionCheck = std::pair<std::string, std::function<void(const Configuration&)>>;
std::vector<SectionCheck> SectionChecks();

}  // namespace rimod
