// What a depth camera or a spinning lidar would see of a simulator's scene, as point clouds in a
// log: for trying rimod-extractor and rimod-detect with --cloud-channel.

#include <CLI/CLI.hpp>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "io/cloud_messages.h"
#include "io/event_log.h"
#include "io/files.h"
#include "io/laser_messages.h"
#include "io/message_codec.h"
#include "scanner_proc/ground_truth.h"
#include "scanner_proc/ray_caster.h"
#include "scanner_proc/scene_file.h"

namespace rimod::simulation {
namespace {

constexpr double kDegree = M_PI / 180.0;

struct Options {
  std::string scene, sensor, log, truth;
  double x = 0.0, y = 0.0, height = 1.1, pitch_deg = 15.0;
  std::vector<double> yaws_deg = {0.0};
  std::vector<double> look_at;  // m, x, y, z in the scene; empty: from x, y
  int seed = 1;
};

// Unit vectors in the sensor's own frame, and how readings err.
struct SensorKind {
  std::vector<Eigen::Vector3d> beams;
  double max_range = 0.0;        // m
  double constant_sigma = 0.0;   // m
  double quadratic_sigma = 0.0;  // m at 1 m of depth, growing with its square
  bool optical_frame = false;    // x right, y down, z forward; else x forward, y left, z up
};

// 320 x 240 pixels, 58 x 45 degrees; the noise of structured light and stereo.
SensorKind DepthCamera() {
  SensorKind kind;
  kind.max_range = 6.0;
  kind.quadratic_sigma = 0.0015;
  kind.optical_frame = true;
  const double focal = 160.0 / std::tan(29.0 * kDegree);  // pixels
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u)
      kind.beams.push_back(
          Eigen::Vector3d((u - 159.5) / focal, (v - 119.5) / focal, 1.0).normalized());
  }
  return kind;
}

// 64 rings over 45 degrees, 1024 beams a turn.
SensorKind SpinningLidar() {
  SensorKind kind;
  kind.max_range = 50.0;
  kind.constant_sigma = 0.008;
  for (int column = 0; column < 1024; ++column) {
    const double azimuth = -2.0 * M_PI * column / 1024.0;
    for (int ring = 0; ring < 64; ++ring) {
      const double elevation = (12.0 - 45.0 * ring / 63.0) * kDegree;
      kind.beams.emplace_back(std::cos(elevation) * std::cos(azimuth),
                              std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    }
  }
  return kind;
}

// The configuration that tells rimod about the mount.
CloudParams Mount(const SensorKind& kind, const Options& options) {
  CloudParams mount;
  mount.mount_z = options.height;
  if (kind.optical_frame) {
    mount.mount_roll = -M_PI / 2.0 - options.pitch_deg * kDegree;
    mount.mount_yaw = -M_PI / 2.0;
  } else {
    mount.mount_pitch = options.pitch_deg * kDegree;
  }
  return mount;
}

// Where the carrier stands when it looks along a yaw (rad).
Eigen::Vector3d CarrierPosition(const Options& options, double yaw) {
  if (options.look_at.empty()) return {options.x, options.y, 0.0};
  const double away = (options.height - options.look_at[2]) / std::tan(options.pitch_deg * kDegree);
  return {options.look_at[0] - away * std::cos(yaw), options.look_at[1] - away * std::sin(yaw),
          0.0};
}

class CloudMaker {
 public:
  CloudMaker(const Scene& scene, const SensorKind& kind, int seed)
      : kind_(kind),
        caster_(scene.objects),
        random_(static_cast<std::mt19937::result_type>(seed)) {}

  SensorCloud Look(const Eigen::Isometry3d& T_scene_sensor, std::map<std::size_t, int>* hits) {
    SensorCloud cloud;
    for (const Eigen::Vector3d& beam : kind_.beams) {
      const Ray ray = {T_scene_sensor.translation(), T_scene_sensor.linear() * beam};
      const std::optional<Hit> hit = caster_.Cast(ray, kind_.max_range);
      if (!hit) continue;
      const double depth = kind_.optical_frame ? hit->range * beam.z() : hit->range;
      const double sigma = kind_.constant_sigma + kind_.quadratic_sigma * depth * depth;
      const double error = std::normal_distribution<double>(0.0, 1.0)(random_) * sigma;
      cloud.points.push_back((beam * (hit->range + error)).cast<float>());
      ++(*hits)[hit->object];
    }
    return cloud;
  }

 private:
  const SensorKind& kind_;
  RayCaster caster_;
  std::mt19937 random_;
};

template <typename Message>
void Write(EventLogWriter* log, const std::string& channel, const Message& message) {
  const std::vector<std::uint8_t> bytes = EncodeMessage(message);
  log->Write(message.utime, channel, bytes.data(), bytes.size());
}

std::vector<ObjectTruth> TruthOf(const Scene& scene, const std::map<std::size_t, int>& hits) {
  std::vector<ObjectTruth> objects;
  for (const auto& [index, num_points] : hits) {
    const SceneObject& object = scene.objects[index];
    if (object.class_name.empty()) continue;
    ObjectTruth truth;
    truth.class_name = object.class_name;
    truth.T_scene_object = ObjectFrameOf(object).T_scene_object;
    truth.num_points = num_points;
    truth.visible = 1.0;  // not computed
    objects.push_back(truth);
  }
  return objects;
}

int Run(const Options& options) {
  const SceneResult read = ReadScene(options.scene);
  if (!read.scene) {
    std::cerr << read.error << '\n';
    return 1;
  }
  const SensorKind kind = options.sensor == "camera" ? DepthCamera() : SpinningLidar();
  const CloudParams mount = Mount(kind, options);
  CloudMaker maker(*read.scene, kind, options.seed);
  EventLogWriter log(options.log);
  std::vector<ScanTruth> truth;
  for (std::size_t i = 0; i < options.yaws_deg.size(); ++i) {
    TimedPose carrier;
    carrier.time = Time(static_cast<std::int64_t>(i + 1) * 1000000);
    carrier.T_local_laser.linear() =
        Eigen::AngleAxisd(options.yaws_deg[i] * kDegree, Eigen::Vector3d::UnitZ())
            .toRotationMatrix();
    carrier.T_local_laser.translation() = CarrierPosition(options, options.yaws_deg[i] * kDegree);
    std::map<std::size_t, int> hits;
    SensorCloud cloud = maker.Look(carrier.T_local_laser * MountPose(mount), &hits);
    cloud.time = carrier.time;
    std::cout << "cloud " << i << ": " << cloud.points.size() << " points\n";
    Write(&log, "CARRIER_TO_LOCAL", ToMessage(carrier));
    Write(&log, "CLOUD", ToMessage(cloud, options.sensor));
    truth.push_back({FileStem(options.log) +
                         (options.yaws_deg.size() > 1 ? "#" + std::to_string(i) : std::string()),
                     TruthOf(*read.scene, hits)});
  }
  std::cout << "cloud:\n  mount_z: " << mount.mount_z
            << "\n  mount_roll_deg: " << mount.mount_roll / kDegree
            << "\n  mount_pitch_deg: " << mount.mount_pitch / kDegree
            << "\n  mount_yaw_deg: " << mount.mount_yaw / kDegree << '\n';
  std::ofstream(options.truth) << TruthJson(truth);
  const std::string error = log.Close();
  std::cerr << error;
  return error.empty() ? 0 : 1;
}

}  // namespace
}  // namespace rimod::simulation

int main(int argc, char** argv) {
  CLI::App app(
      "Writes what a depth camera or a spinning lidar sees of a scene of rimod-simulator: clouds "
      "on\n"
      "CLOUD, the carrier's poses on CARRIER_TO_LOCAL, labels, and on stdout the mount's "
      "configuration.");
  rimod::simulation::Options options;
  app.add_option("scene", options.scene, "Scene file")->required();
  app.add_option("--sensor", options.sensor, "camera or lidar")
      ->required()
      ->check(CLI::IsMember({"camera", "lidar"}));
  app.add_option("--log", options.log, "LCM log to write")->required();
  app.add_option("--truth", options.truth, "Labels to write, JSON")->required();
  app.add_option("--x", options.x, "m, of the carrier");
  app.add_option("--y", options.y, "m, of the carrier");
  app.add_option(
         "--look-at", options.look_at,
         "m, x, y, z in the scene that is seen in the middle from every yaw, instead of --x "
         "and --y; with a pitch other than 0")
      ->expected(3);
  app.add_option("--height", options.height, "m, of the sensor");
  app.add_option("--pitch", options.pitch_deg, "Degrees, > 0 looks down");
  app.add_option("--yaw", options.yaws_deg, "Degrees, a cloud each");
  app.add_option("--seed", options.seed, "Of the noise");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return rimod::simulation::Run(options);
}
