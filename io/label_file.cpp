#include "io/label_file.h"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/files.h"
#include "io/pose_messages.h"
#include "rimod/object_model.h"

namespace rimod {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kMaxBytes = 256'000'000;

// A finite number from low to high under a key that may be absent; false when it is anything else.
bool SetNumber(const Json& json, const char* key, double low, double high, double* value) {
  if (!json.contains(key)) return true;
  if (!json[key].is_number()) return false;
  *value = json[key].get<double>();
  return *value >= low && *value <= high;
}

std::optional<Eigen::Isometry3d> PoseOf(const Json& json) {
  if (!json.contains("pose") || !json["pose"].is_array() || json["pose"].size() != 7)
    return std::nullopt;
  double values[7];
  for (std::size_t i = 0; i < 7; ++i) {
    if (!json["pose"][i].is_number()) return std::nullopt;
    values[i] = json["pose"][i].get<double>();
  }
  return PoseFrom(values, values + 3);
}

// Returns an error text.
std::string SetObject(const Json& json, LabelledObject* object) {
  if (!json.is_object()) return "an object is not a JSON object";
  if (!json.contains("class") || !json["class"].is_string() ||
      !IsValidModelName(json["class"].get<std::string>()))
    return "\"class\" is not a model's name";
  object->class_name = json["class"].get<std::string>();
  const std::optional<Eigen::Isometry3d> pose = PoseOf(json);
  if (!pose) return "\"pose\" is not [tx, ty, tz, qw, qx, qy, qz] with a unit quaternion";
  object->T_local_object = *pose;
  object->distance = pose->translation().head<2>().norm();
  double num_points = object->num_points;
  if (!SetNumber(json, "points", 0.0, 1e9, &num_points)) return "\"points\" is not a count";
  object->num_points = static_cast<int>(num_points);
  if (!SetNumber(json, "visible", 0.0, 1.001, &object->visible))
    return "\"visible\" is not a share of 0 .. 1";
  if (!SetNumber(json, "distance", 0.0, 1e6, &object->distance))
    return "\"distance\" is not in metres";
  return "";
}

std::string SetScan(const Json& json, LabelledScan* scan) {
  if (!json.is_object() || !json.contains("scan") || !json["scan"].is_string())
    return "has no name under \"scan\"";
  scan->scan = json["scan"].get<std::string>();
  if (!json.contains("objects") || !json["objects"].is_array())
    return scan->scan + ": has no list \"objects\"";
  for (const Json& object : json["objects"]) {
    const std::string error = SetObject(object, &scan->objects.emplace_back());
    if (!error.empty()) return scan->scan + ": " + error;
  }
  return "";
}

}  // namespace

LabelFile ParseLabels(const std::string& text, const std::string& name) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("scans") || !json["scans"].is_array())
    return {{}, name + ": is not a JSON object with a list \"scans\""};
  LabelFile labels;
  for (const Json& scan : json["scans"]) {
    const std::string error = SetScan(scan, &labels.scans.emplace_back());
    if (error.empty()) continue;
    return {{}, name + ": scan " + std::to_string(labels.scans.size()) + ": " + error};
  }
  return labels;
}

LabelFile ReadLabelFile(const std::string& path) {
  const FileBytes file = ReadFile(path, kMaxBytes);
  if (!file.bytes) return {{}, file.error};
  return ParseLabels(*file.bytes, path);
}

std::optional<Symmetry> ReadSymmetry(const std::string& recording) {
  const FileBytes file =
      ReadFile((std::filesystem::path(recording) / "model.json").string(), kMaxBytes);
  if (!file.bytes) return std::nullopt;
  const Json json = Json::parse(*file.bytes, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return std::nullopt;
  if (!json.contains("symmetry")) return Symmetry::kNone;
  if (!json["symmetry"].is_string()) return std::nullopt;
  return SymmetryFrom(json["symmetry"].get<std::string>());
}

}  // namespace rimod
