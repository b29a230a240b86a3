#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/bus_params.h"
#include "rimod/params.h"

namespace rimod {

// Everything that a configuration file can set: one file for all processes. To add a struct, add a
// member here, a line a key and a line for Validate() in config_table.cpp.
struct Configuration {
  PipelineParams pipeline;
  BusParams bus;
};

struct ConfigurationResult {
  std::optional<Configuration> configuration;
  std::string error;  // names file, line, section and key; empty when there is a configuration
};

// The values that hold where a configuration file says nothing.
Configuration DefaultConfiguration(Method method);

// Reads YAML: a top-level `method` (paper or default) chooses the base, sections override single
// keys. An unknown section or key, a value of the wrong type or out of range is an error.
// An empty path gives the built-in values.
ConfigurationResult ReadConfiguration(const std::string& path);

// The same from text; name stands for the file in error texts.
ConfigurationResult ParseConfiguration(const std::string& yaml, const std::string& name);

// Complete YAML with every key and a comment each; ParseConfiguration gives the same values back.
std::string DumpConfiguration(const Configuration& configuration);

}  // namespace rimod
