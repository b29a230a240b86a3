#include "io/config.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <stdexcept>

#include "io/config_table.h"
#include "io/config_value.h"
#include "io/files.h"
#include "io/numbers.h"

namespace rimod {
namespace {

constexpr std::int64_t kMaxFileBytes = 1'000'000;

// A mistake in a configuration file.
struct Mistake {
  int line = 0;  // from 1; 0: none in particular
  std::string text;
};

int LineOf(const YAML::Node& node) { return node.Mark().line + 1; }

std::string Place(const ConfigKey& key) {
  return key.section.empty() ? "key '" + key.key + "'"
                             : "section '" + key.section + "', key '" + key.key + "'";
}

std::string Shortened(const std::string& text) { return "'" + text.substr(0, 60) + "'"; }

// Reads one file into one configuration.
class Reader {
 public:
  explicit Reader(Configuration* configuration)
      : configuration_(configuration), table_(ConfigTable(configuration)) {
    for (ConfigKey& key : table_) {
      keys_[{key.section, key.key}] = &key;
      if (!key.section.empty()) sections_.insert(key.section);
    }
  }

  std::optional<Mistake> Read(const YAML::Node& root) {
    if (root.IsNull()) return std::nullopt;  // nothing but comments
    if (!root.IsMap()) return Mistake{LineOf(root), "is not a list of sections"};
    if (std::optional<Mistake> mistake = ReadMethod(root)) return mistake;
    for (const auto& entry : root) {
      std::optional<Mistake> mistake = ReadTopEntry(entry.first, entry.second);
      if (mistake) return mistake;
    }
    return Check();
  }

 private:
  // Before anything else, as it gives all others their base.
  std::optional<Mistake> ReadMethod(const YAML::Node& root) {
    for (const auto& entry : root) {
      if (!entry.first.IsScalar() || entry.first.Scalar() != "method") continue;
      std::optional<Mistake> mistake = ReadValue("", entry.first, entry.second);
      if (mistake) return mistake;
      lines_.clear();  // read again with all others
      const Method method = configuration_->pipeline.method;
      *configuration_ = DefaultConfiguration(method);
      break;
    }
    return std::nullopt;
  }

  std::optional<Mistake> ReadTopEntry(const YAML::Node& name, const YAML::Node& value) {
    if (!name.IsScalar()) return Mistake{LineOf(name), "a section's name is not a word"};
    const std::string& section = name.Scalar();
    if (sections_.count(section) == 0) return ReadValue("", name, value);
    if (!section_lines_.emplace(section, LineOf(name)).second) {
      return Mistake{LineOf(name), "section '" + section + "' is there twice"};
    }
    if (value.IsNull()) return std::nullopt;
    if (!value.IsMap()) return Mistake{LineOf(value), "section '" + section + "' has no keys"};
    for (const auto& entry : value) {
      std::optional<Mistake> mistake = ReadValue(section, entry.first, entry.second);
      if (mistake) return mistake;
    }
    return std::nullopt;
  }

  std::optional<Mistake> ReadValue(const std::string& section, const YAML::Node& name,
                                   const YAML::Node& value) {
    if (!name.IsScalar()) return Mistake{LineOf(name), "a key is not a word"};
    const auto found = keys_.find({section, name.Scalar()});
    if (found == keys_.end()) {
      const std::string where = section.empty() ? "" : " in section '" + section + "'";
      return Mistake{LineOf(name), (section.empty() ? "unknown section or key " : "unknown key ") +
                                       Shortened(name.Scalar()) + where};
    }
    const ConfigKey& key = *found->second;
    if (!lines_.emplace(std::pair(section, key.key), LineOf(name)).second) {
      return Mistake{LineOf(name), Place(key) + " is there twice"};
    }
    const std::string text = value.IsScalar() ? value.Scalar() : "";
    const std::string expected = SetConfigValue(key, text);
    if (expected.empty() && value.IsScalar()) return std::nullopt;
    return Mistake{LineOf(value), Place(key) + ": " + Shortened(text) + " is not " + expected};
  }

  std::optional<Mistake> Check() const {
    for (const auto& [section, check] : SectionChecks()) {
      try {
        check(*configuration_);
      } catch (const std::invalid_argument& invalid) {
        return OutOfRange(section, invalid.what());
      }
    }
    return std::nullopt;
  }

  // The first word of the complaint that is a field of the section gives key and line.
  Mistake OutOfRange(const std::string& section, const std::string& complaint) const {
    std::string words = complaint;
    std::replace_if(
        words.begin(), words.end(),
        [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_'; }, ' ');
    for (const std::string_view word : SplitWords(words)) {
      for (const std::string& name : {std::string(word), std::string(word) + "_deg"}) {
        const auto found = keys_.find({section, name});
        if (found == keys_.end()) continue;
        const auto line = lines_.find({section, name});
        const std::string unit = name == word ? "" : " (in radians)";
        return {line == lines_.end() ? 0 : line->second,
                Place(*found->second) + ": " + complaint + unit};
      }
    }
    const auto line = section_lines_.find(section);
    return {line == section_lines_.end() ? 0 : line->second,
            "section '" + section + "': " + complaint};
  }

  Configuration* configuration_;
  std::vector<ConfigKey> table_;
  std::map<std::pair<std::string, std::string>, const ConfigKey*> keys_;
  std::set<std::string> sections_;
  std::map<std::pair<std::string, std::string>, int> lines_;  // of keys that were read
  std::map<std::string, int> section_lines_;
};

}  // namespace

Configuration DefaultConfiguration(Method method) {
  Configuration configuration;
  configuration.pipeline = DefaultParams(method);
  return configuration;
}

ConfigurationResult ParseConfiguration(const std::string& yaml, const std::string& name) {
  Configuration configuration = DefaultConfiguration(Method::kDefault);
  try {
    const std::optional<Mistake> mistake = Reader(&configuration).Read(YAML::Load(yaml));
    if (!mistake) return {std::move(configuration), ""};
    const std::string line = mistake->line > 0 ? ":" + std::to_string(mistake->line) : "";
    return {std::nullopt, name + line + ": " + mistake->text};
  } catch (const YAML::Exception& exception) {
    return {std::nullopt, name + ":" + std::to_string(exception.mark.line + 1) +
                              ": is not YAML: " + exception.msg};
  }
}

ConfigurationResult ReadConfiguration(const std::string& path) {
  if (path.empty()) return {DefaultConfiguration(Method::kDefault), ""};
  const FileBytes file = ReadFile(path, kMaxFileBytes);
  if (!file.bytes) return {std::nullopt, file.error};
  return ParseConfiguration(*file.bytes, path);
}

std::string DumpConfiguration(const Configuration& configuration) {
  Configuration copy = configuration;
  std::string text;
  std::string section;
  for (const ConfigKey& key : ConfigTable(&copy)) {
    if (key.section != section) text += "\n" + key.section + ":\n";
    section = key.section;
    const std::string indent = section.empty() ? "" : "  ";
    constexpr std::size_t kCommentColumn = 40;
    std::string line = indent + key.key + ": " + ConfigValueText(key);
    line.resize(std::max(line.size() + 1, kCommentColumn), ' ');
    text += line + "# " + key.comment + "\n";
  }
  return text;
}

}  // namespace rimod
