#include "tuning/varied_parameters.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "io/config_table.h"
#include "io/config_value.h"
#include "io/numbers.h"

namespace rimod {
namespace {

std::string NameOf(const ConfigKey& key) { return key.section + "." + key.key; }

std::string DescriptorSection(const PipelineParams& params) {
  return params.descriptor == DescriptorType::kSphericalSpin ? "spherical_spin" : "range_patch";
}

std::set<std::string> SectionsOf(const PipelineParams& params) {
  if (params.method == Method::kDefault)
    return {"range_image", "interest_points", "range_patch", "model_surface", "model_views",
            "matching",    "ranking",         "refinement",  "evidence",      "choice"};
  return {"range_image",       "interest_points", DescriptorSection(params),
          "model_surface",     "model_views",     "matching",
          "goodsac",           "scoring",         "pruning",
          "pose_refinement",   "collisions",      "validation",
          "validation_scoring"};
}

ParameterCost CostOf(const std::string& name) {
  const std::string section = name.substr(0, name.find('.'));
  if (section == "model_surface") return ParameterCost::kSurface;
  if (section == "interest_points" || section == "range_patch" || section == "spherical_spin" ||
      section == "model_views" || name == "range_image.resolution_deg")
    return ParameterCost::kViews;
  return ParameterCost::kSearch;
}

const char* CostText(ParameterCost cost) {
  switch (cost) {
    case ParameterCost::kSurface:
      return "models anew";
    case ParameterCost::kViews:
      return "models' views anew";
    case ParameterCost::kSearch:
      break;
  }
  return "";
}

// The complaint about a configuration; empty: none.
std::string ComplaintAbout(const Configuration& configuration) {
  try {
    for (const auto& [section, check] : SectionChecks()) check(configuration);
  } catch (const std::invalid_argument& invalid) {
    return invalid.what();
  }
  return "";
}

bool IsNumber(const ConfigKey& key) {
  return std::holds_alternative<double*>(key.value) ||
         std::holds_alternative<DegreesOf>(key.value) || std::holds_alternative<int*>(key.value);
}

std::vector<std::string> AllNames(const ConfigKey& key) {
  if (const auto* choice = std::get_if<ChoiceOf>(&key.value)) return choice->names;
  return {"false", "true"};
}

// Sets a range; returns what is wrong with it.
std::string SetRange(const VaryText& vary, const ConfigKey& key, Dimension* dimension) {
  dimension->whole = std::holds_alternative<int*>(key.value);
  if (!vary.low) {
    const double value = ParseNumber(ConfigValueText(key)).value_or(0.0);
    if (!(value > 0.0)) return "needs a range: half to twice its value is none";
    dimension->low = dimension->whole ? std::max(1.0, std::floor(value / 2.0)) : value / 2.0;
    dimension->high = value * 2.0;
    return "";
  }
  const std::optional<double> low = ParseNumber(*vary.low), high = ParseNumber(*vary.high);
  constexpr double kLargest = 1e9;
  for (const std::optional<double>& end : {low, high})
    if (!end || !(std::abs(*end) <= kLargest)) return "its range is not LOW..HIGH, two numbers";
  if (dimension->whole && (*low != std::floor(*low) || *high != std::floor(*high)))
    return "takes whole numbers";
  if (!(*low < *high)) return "its range is empty";
  dimension->low = *low;
  dimension->high = *high;
  return "";
}

// Sets a list; returns what is wrong with it.
std::string SetList(const std::vector<std::string>& values, const ConfigKey& key,
                    Dimension* dimension) {
  for (const std::string& value : values) {
    const std::string expected = SetConfigValue(key, value);
    if (!expected.empty()) return "'" + value.substr(0, 60) + "' is not " + expected;
    const std::string text = ConfigValueText(key);
    const std::vector<std::string>& known = dimension->values;
    if (std::find(known.begin(), known.end(), text) == known.end())
      dimension->values.push_back(text);
  }
  return dimension->values.size() < 2 ? "a list needs two values" : "";
}

// Why none of its values can be used alone; empty: some can.
std::string ComplaintAboutAll(const Dimension& dimension, const Configuration& configuration) {
  constexpr int kProbes = 8;
  std::string complaint;
  for (int i = 0; i <= kProbes; ++i) {
    const std::string value = dimension.ValueAt(static_cast<double>(i) / kProbes);
    const AppliedSetting applied = ApplySetting({dimension}, {value}, configuration);
    if (applied.configuration) return "";
    complaint = applied.error;
  }
  return complaint;
}

std::string NotTunable(const std::string& name, const Configuration& configuration) {
  Configuration copy = configuration;
  for (const ConfigKey& key : ConfigTable(&copy)) {
    if (NameOf(key) != name || key.section.empty()) continue;
    const PipelineParams& params = configuration.pipeline;
    const std::string method =
        params.method == Method::kDefault ? "the default method" : "the paper's method";
    return name + ": " + method + " with " + DescriptorSection(params) +
           " does not use it in single scans";
  }
  return "'" + name.substr(0, 80) + "' is no parameter; --list shows all";
}

}  // namespace

std::vector<TunableParameter> TunableParameters(const Configuration& configuration) {
  Configuration copy = configuration;
  std::vector<TunableParameter> parameters;
  const std::set<std::string> sections = SectionsOf(copy.pipeline);
  for (const ConfigKey& key : ConfigTable(&copy)) {
    if (sections.count(key.section) == 0) continue;
    const std::string name = NameOf(key);
    parameters.push_back({name, ConfigValueText(key), key.comment, CostOf(name)});
  }
  return parameters;
}

std::string TunableParametersText(const Configuration& configuration) {
  constexpr std::size_t kValueColumn = 42, kCostColumn = 62, kCommentColumn = 82;
  std::string text;
  for (const TunableParameter& parameter : TunableParameters(configuration)) {
    std::string line = parameter.name;
    for (const auto& [column, word] :
         {std::pair(kValueColumn, parameter.value),
          std::pair(kCostColumn, std::string(CostText(parameter.cost))),
          std::pair(kCommentColumn, parameter.comment)}) {
      line.resize(std::max(line.size() + 1, column), ' ');
      line += word;
    }
    text += line + "\n";
  }
  return text;
}

std::vector<std::string> DefaultVaryTexts(const PipelineParams& params) {
  if (params.descriptor == DescriptorType::kSphericalSpin)
    return {"spherical_spin.support_size", "matching.max_descriptor_distance",
            "goodsac.distance_tolerance=0.025..0.1", "validation_scoring.epsilon=0.03..0.12",
            "validation.min_score=0.05..0.5"};
  if (params.method == Method::kPaper)
    return {"range_patch.support_size=0.2..0.6", "matching.max_descriptor_distance=0.025..0.1",
            "goodsac.distance_tolerance=0.025..0.1", "validation_scoring.epsilon=0.03..0.12",
            "validation.min_score=0.05..0.5"};
  return {"choice.min_probability=0.2..0.9",   "evidence.depth_tolerance=0.015..0.06",
          "ranking.fine_epsilon=0.025..0.1",   "matching.max_descriptor_distance=0.035..0.14",
          "range_patch.support_size=0.2..0.6", "interest_points.suppression_radius=0.02..0.08"};
}

DimensionResult DimensionFrom(const std::string& text, const Configuration& configuration) {
  const std::optional<VaryText> vary = ParseVaryText(text);
  if (!vary)
    return {std::nullopt, "'" + text.substr(0, 80) + "' is not KEY, KEY=LOW..HIGH or KEY=A,B"};
  Configuration copy = configuration;
  const std::set<std::string> sections = SectionsOf(copy.pipeline);
  for (const ConfigKey& key : ConfigTable(&copy)) {
    if (NameOf(key) != vary->name || sections.count(key.section) == 0) continue;
    Dimension dimension;
    dimension.name = vary->name;
    const bool list = !vary->values.empty() || !IsNumber(key);
    if (vary->low && !IsNumber(key)) return {std::nullopt, vary->name + ": takes a list, no range"};
    std::string error =
        list ? SetList(vary->values.empty() ? AllNames(key) : vary->values, key, &dimension)
             : SetRange(*vary, key, &dimension);
    if (error.empty()) error = ComplaintAboutAll(dimension, configuration);
    if (!error.empty()) return {std::nullopt, vary->name + ": " + error};
    return {std::move(dimension), ""};
  }
  return {std::nullopt, NotTunable(vary->name, configuration)};
}

Setting SettingOf(const std::vector<Dimension>& dimensions, const Configuration& configuration) {
  Configuration copy = configuration;
  const std::vector<ConfigKey> table = ConfigTable(&copy);
  Setting setting;
  for (const Dimension& dimension : dimensions)
    for (const ConfigKey& key : table)
      if (NameOf(key) == dimension.name) setting.push_back(ConfigValueText(key));
  return setting;
}

AppliedSetting ApplySetting(const std::vector<Dimension>& dimensions, const Setting& setting,
                            const Configuration& base) {
  Configuration configuration = base;
  const std::vector<ConfigKey> table = ConfigTable(&configuration);
  for (std::size_t i = 0; i < dimensions.size(); ++i) {
    for (const ConfigKey& key : table) {
      if (NameOf(key) != dimensions[i].name) continue;
      const std::string expected = SetConfigValue(key, setting[i]);
      if (!expected.empty())
        return {std::nullopt, dimensions[i].name + ": " + setting[i] + " is not " + expected};
    }
  }
  const std::string complaint = ComplaintAbout(configuration);
  if (!complaint.empty()) return {std::nullopt, complaint};
  return {std::move(configuration), ""};
}

ParameterCost CostOfChange(const std::vector<Dimension>& dimensions, const Setting& a,
                           const Setting& b) {
  ParameterCost cost = ParameterCost::kSearch;
  for (std::size_t i = 0; i < dimensions.size(); ++i)
    if (a[i] != b[i]) cost = std::max(cost, CostOf(dimensions[i].name));
  return cost;
}

std::string ShortConfigurationText(const Configuration& configuration,
                                   const std::vector<std::string>& head) {
  Configuration copy = configuration;
  Configuration own = DefaultConfiguration(configuration.pipeline.method);
  const std::vector<ConfigKey> table = ConfigTable(&copy);
  const std::vector<ConfigKey> own_table = ConfigTable(&own);
  std::string text;
  for (const std::string& line : head) text += "# " + line + "\n";
  std::string section;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::string value = ConfigValueText(table[i]);
    const bool top = table[i].section.empty();
    if (!top && value == ConfigValueText(own_table[i])) continue;
    if (table[i].section != section) text += "\n" + table[i].section + ":\n";
    section = table[i].section;
    text += (top ? "" : "  ") + table[i].key + ": " + value + "\n";
  }
  return text;
}

}  // namespace rimod
