#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/config.h"
#include "tuning/search_space.h"

namespace rimod {

// What must be done anew when a parameter is another.
enum class ParameterCost {
  kSearch,   // detection alone
  kViews,    // features of scans and of the models' views
  kSurface,  // the models, from their recordings
};

// A parameter that may be varied.
struct TunableParameter {
  std::string name;  // "section.key"
  std::string value;
  std::string comment;  // meaning, unit and range
  ParameterCost cost = ParameterCost::kSearch;
};

// Those that the configuration's method and descriptor use in single scans, in the order of the
// pipeline.
std::vector<TunableParameter> TunableParameters(const Configuration& configuration);
std::string TunableParametersText(const Configuration& configuration);

// What is varied when the user names nothing; docs/tuning.md has the reasons.
std::vector<std::string> DefaultVaryTexts(const PipelineParams& params);

struct DimensionResult {
  std::optional<Dimension> dimension;
  std::string error;  // names the parameter; empty when there is a dimension
};
// A dimension from "section.key=LOW..HIGH", "section.key=A,B" or "section.key": numbers then go
// from half to twice the configuration's value, names and true or false take all there are.
DimensionResult DimensionFrom(const std::string& text, const Configuration& configuration);

// The dimensions' values in the configuration.
Setting SettingOf(const std::vector<Dimension>& dimensions, const Configuration& configuration);

struct AppliedSetting {
  std::optional<Configuration> configuration;
  std::string error;  // why the values cannot be combined
};
AppliedSetting ApplySetting(const std::vector<Dimension>& dimensions, const Setting& setting,
                            const Configuration& base);

// The largest cost of the values in which two settings differ.
ParameterCost CostOfChange(const std::vector<Dimension>& dimensions, const Setting& a,
                           const Setting& b);

// A configuration file with what differs from the method's own values; ReadConfiguration gives the
// configuration again. Lines of the head become comments.
std::string ShortConfigurationText(const Configuration& configuration,
                                   const std::vector<std::string>& head);

}  // namespace rimod
