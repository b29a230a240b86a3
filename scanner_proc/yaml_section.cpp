#include "scanner_proc/yaml_section.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace rimod::simulation {
namespace {

std::string Text(double value) {
  std::ostringstream text;
  text.precision(15);
  text << value;
  return text.str();
}

// A value as it stands in the file, shortened for messages.
std::string Quoted(const YAML::Node& node) {
  constexpr std::size_t kLongest = 40;
  if (!node.IsScalar()) return node.IsMap() ? "a map" : node.IsSequence() ? "a list" : "nothing";
  const std::string& text = node.Scalar();
  return "'" + (text.size() <= kLongest ? text : text.substr(0, kLongest) + "...") + "'";
}

}  // namespace

YamlSection::YamlSection(const YAML::Node& node, std::string file, std::string path)
    : node_(node), file_(std::move(file)), path_(std::move(path)) {
  if (!node_.IsMap()) Fail("", "must be a map of keys and values, is " + Quoted(node_));
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) Fail("", "has a key that is no word");
    if (!seen.insert(entry.first.Scalar()).second) Fail(entry.first.Scalar(), "stands there twice");
  }
}

std::string YamlSection::PathOf(const std::string& key) const {
  return path_.empty() ? key : key.empty() ? path_ : path_ + "." + key;
}

void YamlSection::Fail(const std::string& key, const std::string& cause) const {
  int line = node_.Mark().line;
  if (!key.empty() && node_.IsMap()) {
    for (const auto& entry : node_) {
      if (entry.first.IsScalar() && entry.first.Scalar() == key) line = entry.first.Mark().line;
    }
  }
  const std::string path = PathOf(key);
  throw YamlError(file_ + ":" + std::to_string(std::max(line, 0) + 1) + ": " +
                  (path.empty() ? "the file" : path) + ": " + cause);
}

bool YamlSection::Has(const std::string& key) const { return node_[key].IsDefined(); }

void YamlSection::Require(const std::string& key) const {
  if (!Has(key)) Fail("", "lacks the key " + key);
}

YAML::Node YamlSection::Node(const std::string& key) {
  known_.insert(key);
  const YAML::Node& node = node_;  // the other operator[] would add the key
  return node[key];
}

YamlSection YamlSection::Section(const std::string& key) {
  Require(key);
  return YamlSection(Node(key), file_, PathOf(key));
}

std::vector<YamlSection> YamlSection::Sections(const std::string& key) {
  constexpr std::size_t kMost = 1000000;  // one file can name a list over and over
  std::vector<YamlSection> sections;
  const YAML::Node list = Node(key);
  if (!list.IsDefined()) return sections;
  if (!list.IsSequence()) Fail(key, "must be a list, is " + Quoted(list));
  if (list.size() > kMost) Fail(key, "has too many entries");
  for (std::size_t i = 0; i < list.size(); ++i) {
    sections.emplace_back(list[i], file_, PathOf(key) + "[" + std::to_string(i) + "]");
  }
  return sections;
}

std::vector<std::string> YamlSection::Keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : node_) keys.push_back(entry.first.Scalar());
  return keys;
}

double YamlSection::Number(const YAML::Node& node, const std::string& key,
                           const Limits& limits) const {
  double value = 0.0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) {
    Fail(key, "must be a number, is " + Quoted(node));
  }
  if (!(value >= limits.least && value <= limits.most)) {
    Fail(key, "is " + Text(value) + ", must be " + Text(limits.least) + " .. " + Text(limits.most));
  }
  return value;
}

void YamlSection::Read(const std::string& key, const Limits& limits, double* value) {
  if (const YAML::Node node = Node(key); node.IsDefined()) *value = Number(node, key, limits);
}

void YamlSection::ReadInt(const std::string& key, const Limits& limits, int* value) {
  std::int64_t wide = *value;
  ReadInt64(key, limits, &wide);
  *value = static_cast<int>(wide);
}

void YamlSection::ReadInt64(const std::string& key, const Limits& limits, std::int64_t* value) {
  const YAML::Node node = Node(key);
  if (!node.IsDefined()) return;
  std::int64_t whole = 0;
  if (!node.IsScalar() || !YAML::convert<std::int64_t>::decode(node, whole)) {
    Fail(key, "must be a whole number, is " + Quoted(node));
  }
  *value = static_cast<std::int64_t>(whole);
  Number(node, key, limits);
}

void YamlSection::ReadDegrees(const std::string& key, const Limits& limits_deg, double* value) {
  if (const YAML::Node node = Node(key); node.IsDefined()) {
    *value = Number(node, key, limits_deg) * M_PI / 180.0;
  }
}

void YamlSection::ReadBool(const std::string& key, bool* value) {
  const YAML::Node node = Node(key);
  if (!node.IsDefined()) return;
  if (!node.IsScalar() || !YAML::convert<bool>::decode(node, *value)) {
    Fail(key, "must be true or false, is " + Quoted(node));
  }
}

void YamlSection::ReadString(const std::string& key, std::string* value) {
  const YAML::Node node = Node(key);
  if (!node.IsDefined()) return;
  if (!node.IsScalar()) Fail(key, "must be a text, is " + Quoted(node));
  *value = node.Scalar();
}

void YamlSection::ReadStrings(const std::string& key, std::vector<std::string>* values) {
  const YAML::Node node = Node(key);
  if (!node.IsDefined()) return;
  if (!node.IsSequence()) Fail(key, "must be a list of texts, is " + Quoted(node));
  values->clear();
  for (const YAML::Node& element : node) {
    if (!element.IsScalar()) Fail(key, "must hold texts, holds " + Quoted(element));
    values->push_back(element.Scalar());
  }
}

void YamlSection::ReadList(const std::string& key, const Limits& limits, std::size_t least_size,
                           std::size_t most_size, std::vector<double>* values) {
  const YAML::Node node = Node(key);
  if (!node.IsDefined()) return;
  const bool size_fits = node.IsSequence() && node.size() >= least_size && node.size() <= most_size;
  if (!size_fits) {
    const std::string size = least_size == most_size
                                 ? std::to_string(least_size)
                                 : std::to_string(least_size) + " .. " + std::to_string(most_size);
    Fail(key, "must be a list of " + size + " numbers");
  }
  values->clear();
  for (const YAML::Node& element : node) values->push_back(Number(element, key, limits));
}

void YamlSection::ReadVector3(const std::string& key, const Limits& limits,
                              Eigen::Vector3d* value) {
  std::vector<double> values = {value->x(), value->y(), value->z()};
  ReadList(key, limits, 3, 3, &values);
  *value = Eigen::Vector3d(values[0], values[1], values[2]);
}

void YamlSection::ReadVector2(const std::string& key, const Limits& limits,
                              Eigen::Vector2d* value) {
  std::vector<double> values = {value->x(), value->y()};
  ReadList(key, limits, 2, 2, &values);
  *value = Eigen::Vector2d(values[0], values[1]);
}

void YamlSection::RejectOtherKeys() const {
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (known_.count(key) != 0) continue;
    std::string keys;
    for (const std::string& known : known_) keys += (keys.empty() ? "" : ", ") + known;
    Fail(key, "unknown key; known here are " + keys);
  }
}

}  // namespace rimod::simulation
