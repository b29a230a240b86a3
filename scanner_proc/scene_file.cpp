#include "scanner_proc/scene_file.h"

#include <filesystem>

#include "io/files.h"
#include "scanner_proc/scene_object_reader.h"
#include "scanner_proc/yaml_section.h"

namespace rimod::simulation {
namespace {

constexpr std::int64_t kMaxFileSize = 16 << 20;  // bytes; far beyond any scene written by a person
constexpr Limits kCoordinate = {-10000.0, 10000.0};
constexpr Limits kAnyAngle = {-360.0, 360.0};
constexpr int kMaxLines = 20000;  // of a sweep

YAML::Node Parse(const std::string& path) {
  const FileBytes file = ReadFile(path, kMaxFileSize);
  if (!file.bytes) throw YamlError(file.error);
  try {
    return YAML::Load(*file.bytes);
  } catch (const YAML::Exception& error) {
    throw YamlError(path + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}

void ReadScanGeometry(YamlSection* section, Sensor* sensor) {
  section->ReadDegrees("tilt_start_deg", {-180.0, 180.0}, &sensor->tilt_start);
  section->ReadDegrees("tilt_end_deg", {-180.0, 180.0}, &sensor->tilt_end);
  section->ReadDegrees("tilt_step_deg", {0.001, 45.0}, &sensor->tilt_step);
  section->ReadDegrees("first_angle_deg", kAnyAngle, &sensor->first_angle);
  section->ReadDegrees("angle_step_deg", {0.001, 45.0}, &sensor->angle_step);
  section->ReadInt("num_beams", {2, 16384}, &sensor->num_beams);
  section->ReadBool("interlaced", &sensor->interlaced);
  if (sensor->angle_step * (sensor->num_beams - 1) > 2.0 * M_PI) {
    section->Fail("num_beams", "a line must not be longer than a turn");
  }
  if (std::abs(sensor->tilt_end - sensor->tilt_start) / sensor->tilt_step > kMaxLines) {
    section->Fail("tilt_step_deg", "gives more than " + std::to_string(kMaxLines) + " lines");
  }
}

void ReadSensor(YamlSection section, Sensor* sensor) {
  section.ReadVector3("position", kCoordinate, &sensor->position);
  section.ReadDegrees("yaw_deg", kAnyAngle, &sensor->yaw);
  ReadScanGeometry(&section, sensor);
  section.Read("line_period", {0.0001, 10.0}, &sensor->line_period);
  section.Read("max_range", {0.1, 10000.0}, &sensor->max_range);
  section.Read("no_return", {0.1, 100000.0}, &sensor->no_return);
  section.Read("pause", {0.0, 60.0}, &sensor->pause);
  section.Read("speed", {-10.0, 10.0}, &sensor->speed);
  section.ReadDegrees("turn_rate_deg", kAnyAngle, &sensor->turn_rate);
  if (sensor->no_return < sensor->max_range) {
    section.Fail("no_return", "must not be below max_range");
  }
  section.RejectOtherKeys();
}

void ReadNoise(YamlSection section, Noise* noise) {
  section.Read("range_sigma", {0.0, 1.0}, &noise->range_sigma);
  section.Read("range_step", {0.0, 1.0}, &noise->range_step);
  section.ReadDegrees("angle_sigma_deg", {0.0, 5.0}, &noise->angle_sigma);
  section.ReadDegrees("beam_divergence_deg", {0.0, 10.0}, &noise->beam_divergence);
  section.ReadInt("rays_per_beam", {1, 64}, &noise->rays_per_beam);
  section.Read("mixing_distance", {0.0, 100.0}, &noise->mixing_distance);
  section.Read("drop_out", {0.0, 1.0}, &noise->drop_out);
  section.Read("dark_signal", {0.0, 1.0}, &noise->dark_signal);
  section.RejectOtherKeys();
}

void ReadRecordingPlan(YamlSection section, RecordingPlan* plan) {
  section.ReadInt("views", {1, 1000}, &plan->num_views);
  section.Read("distance", {0.0, 100.0}, &plan->distance);
  section.ReadList("heights", kCoordinate, 1, 100, &plan->heights);
  section.RejectOtherKeys();
}

// A rectangle whose x-axis and y-axis point along these axes of the scene.
Part MakeWall(const Eigen::Vector3d& centre, const Eigen::Vector3d& x_axis,
              const Eigen::Vector3d& y_axis, const Eigen::Vector3d& room_size,
              double reflectivity) {
  Part part;
  part.shape = RectangleShape{{room_size.dot(x_axis), room_size.dot(y_axis)}};
  part.T_object_part.linear() << x_axis, y_axis, x_axis.cross(y_axis);
  part.T_object_part.translation() = centre;
  part.reflectivity = reflectivity;
  return part;
}

SceneObject ReadRoom(YamlSection section) {
  section.Require("min");
  section.Require("max");
  Eigen::Vector3d min = Eigen::Vector3d::Zero();
  Eigen::Vector3d max = Eigen::Vector3d::Zero();
  section.ReadVector3("min", kCoordinate, &min);
  section.ReadVector3("max", kCoordinate, &max);
  if (!(min.array() < max.array()).all()) section.Fail("max", "must be above min in x, y and z");
  double reflectivity = Part().reflectivity;
  section.Read("reflectivity", {0.0, 1.0}, &reflectivity);
  bool floor = true, walls = true, ceiling = true;
  section.ReadBool("floor", &floor);
  section.ReadBool("walls", &walls);
  section.ReadBool("ceiling", &ceiling);
  section.RejectOtherKeys();

  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d size = max - min;
  const Eigen::Vector3d middle = 0.5 * (min + max);
  const auto at = [&](int axis, double value) {
    Eigen::Vector3d centre = middle;
    centre[axis] = value;
    return centre;
  };
  SceneObject room;
  room.name = "room";
  if (floor) room.parts.push_back(MakeWall(at(2, min.z()), x, y, size, reflectivity));
  if (ceiling) room.parts.push_back(MakeWall(at(2, max.z()), x, y, size, reflectivity));
  if (walls) {
    room.parts.push_back(MakeWall(at(0, min.x()), y, z, size, reflectivity));
    room.parts.push_back(MakeWall(at(0, max.x()), y, z, size, reflectivity));
    room.parts.push_back(MakeWall(at(1, min.y()), x, z, size, reflectivity));
    room.parts.push_back(MakeWall(at(1, max.y()), x, z, size, reflectivity));
  }
  return room;
}

// Included files bring shapes and, where the scene says nothing itself, sensor and noise.
void ReadIncludes(YamlSection* top, SceneObjectReader* objects, Scene* scene) {
  std::vector<std::string> includes;
  top->ReadStrings("include", &includes);
  const std::filesystem::path folder = std::filesystem::path(top->file()).parent_path();
  for (const std::string& include : includes) {
    const std::string path = (folder / include).string();
    YamlSection section(Parse(path), path, "");
    if (section.Has("sensor")) ReadSensor(section.Section("sensor"), &scene->sensor);
    if (section.Has("noise")) ReadNoise(section.Section("noise"), &scene->noise);
    if (section.Has("shapes")) objects->ReadShapes(section.Section("shapes"));
    section.RejectOtherKeys();
  }
}

Scene ReadSceneOrThrow(const std::string& path) {
  YamlSection top(Parse(path), path, "");
  Scene scene;
  scene.name = FileStem(path);
  SceneObjectReader objects;
  ReadIncludes(&top, &objects, &scene);
  top.ReadString("name", &scene.name);
  std::int64_t seed = static_cast<std::int64_t>(scene.seed);
  top.ReadInt64("seed", {0.0, 9e15}, &seed);
  scene.seed = static_cast<std::uint64_t>(seed);
  top.ReadInt64("start_utime", {0.0, 4e18}, &scene.start_utime);
  if (top.Has("sensor")) ReadSensor(top.Section("sensor"), &scene.sensor);
  if (top.Has("noise")) ReadNoise(top.Section("noise"), &scene.noise);
  if (top.Has("recording")) ReadRecordingPlan(top.Section("recording"), &scene.recording);
  if (top.Has("shapes")) objects.ReadShapes(top.Section("shapes"));
  if (top.Has("room")) scene.objects.push_back(ReadRoom(top.Section("room")));
  for (SceneObject& object : objects.ReadObjects(&top, "objects")) {
    scene.objects.push_back(std::move(object));
  }
  top.RejectOtherKeys();
  if (scene.objects.empty()) top.Fail("", "has neither a room nor objects");
  return scene;
}

}  // namespace

SceneResult ReadScene(const std::string& path) {
  try {
    return {ReadSceneOrThrow(path), ""};
  } catch (const YamlError& error) {
    return {std::nullopt, error.what()};
  } catch (const YAML::Exception& error) {
    return {std::nullopt, path + ": " + error.what()};
  }
}

}  // namespace rimod::simulation
