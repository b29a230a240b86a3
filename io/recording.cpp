#include "io/recording.h"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "io/files.h"
#include "io/point_cloud_file.h"
#include "io/pose_messages.h"

namespace rimod {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kMaxJsonBytes = 1'000'000;
constexpr char kDescriptionFile[] = "model.json";

std::string DescriptionPath(const std::string& folder) {
  return (std::filesystem::path(folder) / kDescriptionFile).string();
}

// N numbers of a JSON array. Nothing when it is anything else or a number is not finite.
template <std::size_t N>
std::optional<std::array<double, N>> NumbersFrom(const Json& json) {
  if (!json.is_array() || json.size() != N) return std::nullopt;
  std::array<double, N> numbers{};
  for (std::size_t i = 0; i < N; ++i) {
    if (!json[i].is_number()) return std::nullopt;
    numbers[i] = json[i].get<double>();
    if (!std::isfinite(numbers[i])) return std::nullopt;
  }
  return numbers;
}

const Json& Member(const Json& json, const char* key) {
  static const Json kNothing;
  const auto found = json.is_object() ? json.find(key) : json.end();
  return json.is_object() && found != json.end() ? *found : kNothing;
}

// The class that a description names; nothing when it is no valid name.
std::optional<std::string> ClassFrom(const Json& json) {
  const Json& name = Member(json, "class");
  if (!name.is_string() || !IsValidModelName(name.get<std::string>())) return std::nullopt;
  return name.get<std::string>();
}

// Sets all but the scans. Returns an error text.
std::string SetDescription(const Json& json, Recording* recording) {
  const std::optional<std::string> name = ClassFrom(json);
  if (!name) return "'class' is not a name of letters, digits, '_', '-' or '.'";
  const auto pose = NumbersFrom<7>(Member(json, "object_pose"));
  const std::optional<Eigen::Isometry3d> T_local_object =
      pose ? PoseFrom(pose->data(), pose->data() + 3) : std::nullopt;
  if (!T_local_object) return "'object_pose' is not seven numbers tx ty tz qw qx qy qz of a pose";
  const Json& box = Member(json, "box");
  const auto box_min = NumbersFrom<3>(Member(box, "min"));
  const auto box_max = NumbersFrom<3>(Member(box, "max"));
  if (!box_min || !box_max) return "'box' has not 'min' and 'max' of three numbers each";
  recording->class_name = *name;
  recording->T_local_object = *T_local_object;
  recording->box_min = Eigen::Vector3d(box_min->data());
  recording->box_max = Eigen::Vector3d(box_max->data());
  const Eigen::Vector3d size = recording->box_max - recording->box_min;
  constexpr double kLargestObject = 100.0;  // m
  if (!(size.minCoeff() > 0.0 && size.maxCoeff() <= kLargestObject)) {
    return "'box' is empty or larger than 100 m";
  }
  return "";
}

struct JsonResult {
  Json json;
  std::string error;
};

JsonResult ReadJson(const std::string& path) {
  const FileBytes file = ReadFile(path, kMaxJsonBytes);
  if (!file.bytes) return {Json(), file.error};
  Json json = Json::parse(*file.bytes, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) return {Json(), path + ": is not JSON"};
  return {std::move(json), ""};
}

}  // namespace

RecordingResult ReadRecordingDescription(const std::string& folder) {
  RecordingResult result;
  const std::string path = DescriptionPath(folder);
  JsonResult description = ReadJson(path);
  if (!description.error.empty()) {
    result.error = description.error;
    return result;
  }
  Recording recording;
  const std::string complaint = SetDescription(description.json, &recording);
  if (complaint.empty()) {
    result.recording = std::move(recording);
  } else {
    result.error = path + ": " + complaint;
  }
  return result;
}

RecordingResult ReadRecording(const std::string& folder) {
  RecordingResult result = ReadRecordingDescription(folder);
  if (!result.recording) return result;
  Recording recording = *std::move(result.recording);
  result.recording.reset();
  const FolderListing scans = ListFolder(folder, "scan_", ".pcd");
  for (const std::string& scan_path : scans.paths) {
    PointCloudResult cloud = ReadPointCloud(scan_path);
    if (!cloud.warning.empty()) result.warnings.push_back(cloud.warning);
    if (cloud.scan) {
      recording.scans.push_back(std::move(*cloud.scan));
    } else {
      result.warnings.push_back(cloud.error + " (left out)");
    }
  }
  if (recording.scans.empty()) {
    result.error = folder + ": has no usable scan_*.pcd";
    return result;
  }
  result.recording = std::move(recording);
  return result;
}

std::optional<std::string> ReadClassName(const std::string& folder) {
  const JsonResult description = ReadJson(DescriptionPath(folder));
  return description.error.empty() ? ClassFrom(description.json) : std::nullopt;
}

}  // namespace rimod
