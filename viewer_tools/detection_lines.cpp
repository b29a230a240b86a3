#include "viewer_tools/detection_lines.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/files.h"
#include "io/pose_messages.h"
#include "rimod/object_model.h"

namespace rimod {
namespace {

using Json = nlohmann::json;

// The pose [tx, ty, tz, qw, qx, qy, qz], if it is one.
std::optional<Eigen::Isometry3d> ParsePose(const Json& json) {
  if (!json.is_array() || json.size() != 7) return std::nullopt;
  double values[7];
  for (std::size_t i = 0; i < 7; ++i) {
    if (!json[i].is_number()) return std::nullopt;
    values[i] = json[i].get<double>();
  }
  return PoseFrom(values, values + 3);
}

}  // namespace

ParsedDetectionLine ParseDetectionLine(const std::string& text) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return {std::nullopt, "is not a JSON object"};
  for (const char* key : {"scan", "class", "pose", "score"})
    if (!json.contains(key)) return {std::nullopt, std::string("has no \"") + key + "\""};
  if (!json["scan"].is_string()) return {std::nullopt, "\"scan\" is not a text"};
  if (!json["class"].is_string() || !IsValidModelName(json["class"].get<std::string>()))
    return {std::nullopt, "\"class\" is not a model's name"};
  const std::optional<Eigen::Isometry3d> T_local_object = ParsePose(json["pose"]);
  if (!T_local_object)
    return {std::nullopt, "\"pose\" is not [tx, ty, tz, qw, qx, qy, qz] with a unit quaternion"};
  if (!json["score"].is_number() || !std::isfinite(json["score"].get<double>()))
    return {std::nullopt, "\"score\" is not a number"};

  DetectionLine line;
  line.scan = json["scan"].get<std::string>();
  line.detection.class_name = json["class"].get<std::string>();
  line.detection.T_local_object = *T_local_object;
  line.detection.score = json["score"].get<double>();
  return {std::move(line), ""};
}

DetectionLines ReadDetectionLines(const std::string& path) {
  constexpr std::int64_t kMaxBytes = 256'000'000;
  const FileBytes file = ReadFile(path, kMaxBytes);
  if (!file.bytes) return {{}, file.error};
  DetectionLines result;
  std::istringstream stream(*file.bytes);
  std::string text;
  for (int number = 1; std::getline(stream, text); ++number) {
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    ParsedDetectionLine parsed = ParseDetectionLine(text);
    if (parsed.line) {
      result.lines.push_back(std::move(*parsed.line));
    } else if (result.error.empty()) {
      result.error = path + ": line " + std::to_string(number) + " " + parsed.error;
    }
  }
  return result;
}

}  // namespace rimod
