#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace rimod::simulation {

// A file that says something illegal; what() names file, line, key and cause.
class YamlError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Limits {
  double least;
  double most;
};

// One map of a YAML file, read key by key: values are checked against limits, and a key that nobody
// asked for is an error. Every method throws YamlError. A missing key leaves *value alone.
class YamlSection {
 public:
  // path says where in the file the map stands, e.g. "objects[3].box"; empty at the top.
  YamlSection(const YAML::Node& node, std::string file, std::string path);

  bool Has(const std::string& key) const;
  void Require(const std::string& key) const;
  // Marks the key as known.
  YAML::Node Node(const std::string& key);
  YamlSection Section(const std::string& key);
  // The maps of a list; empty where the key is missing. At most a million.
  std::vector<YamlSection> Sections(const std::string& key);
  // All keys, as they stand in the file.
  std::vector<std::string> Keys() const;

  void Read(const std::string& key, const Limits& limits, double* value);
  void ReadInt(const std::string& key, const Limits& limits, int* value);
  void ReadInt64(const std::string& key, const Limits& limits, std::int64_t* value);
  // key holds degrees, *value radians.
  void ReadDegrees(const std::string& key, const Limits& limits_deg, double* value);
  void ReadBool(const std::string& key, bool* value);
  void ReadString(const std::string& key, std::string* value);
  void ReadStrings(const std::string& key, std::vector<std::string>* values);
  // A list of numbers, every one within limits, as many as least_size .. most_size.
  void ReadList(const std::string& key, const Limits& limits, std::size_t least_size,
                std::size_t most_size, std::vector<double>* values);
  void ReadVector3(const std::string& key, const Limits& limits, Eigen::Vector3d* value);
  void ReadVector2(const std::string& key, const Limits& limits, Eigen::Vector2d* value);

  // Names the first key that was not asked for.
  void RejectOtherKeys() const;
  // Throws: "FILE:LINE: PATH.KEY: cause". An empty key means the section itself.
  [[noreturn]] void Fail(const std::string& key, const std::string& cause) const;

  const std::string& file() const { return file_; }
  const std::string& path() const { return path_; }
  std::string PathOf(const std::string& key) const;

 private:
  double Number(const YAML::Node& node, const std::string& key, const Limits& limits) const;

  YAML::Node node_;
  std::string file_;
  std::string path_;
  std::set<std::string> known_;
};

}  // namespace rimod::simulation
