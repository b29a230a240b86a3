#include "scanner_proc/simulated_sweeps.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "io/event_log.h"
#include "io/files.h"
#include "io/laser_messages.h"
#include "io/message_codec.h"
#include "io/point_cloud_file.h"
#include "rimod/sweep_assembler.h"
#include "scanner_proc/ground_truth.h"
#include "scanner_proc/laser_scanner.h"
#include "scanner_proc/ray_caster.h"

namespace rimod::simulation {
namespace {

constexpr char kStopped[] = "stopped";

// "out/000.pcd" -> "out/000#2.pcd", when there are several sweeps.
std::string NumberedPath(const std::string& path, int sweep, int num_sweeps) {
  if (num_sweeps == 1) return path;
  const std::filesystem::path plain(path);
  const std::string name =
      FileStem(path) + "#" + std::to_string(sweep) + plain.extension().string();
  return (plain.parent_path() / name).string();
}

// As rimod-detect names the sweeps of a log.
std::string SweepName(const Scene& scene, const SweepFiles& files, int sweep, int num_sweeps) {
  const std::string name = !files.log.empty()   ? FileStem(files.log)
                           : !files.pcd.empty() ? FileStem(files.pcd)
                                                : scene.name;
  return num_sweeps == 1 ? name : name + "#" + std::to_string(sweep);
}

// Takes a scanner's lines one after the other and writes what is wanted of them.
class SweepWriter {
 public:
  SweepWriter(const Scene& scene, int num_sweeps, const Channels& channels,
              const SweepParams& params, const SweepFiles& files)
      : scene_(scene),
        num_sweeps_(num_sweeps),
        laser_channel_(channels.laser),
        pose_channel_(channels.laser_to_local),
        files_(files),
        assembler_(params) {
    if (!files.log.empty()) log_.emplace(files.log);
    if (!files.truth.empty()) truth_.emplace(scene);
  }

  // Both go on as a receiver of the messages has them, so that log and clouds agree to the bit.
  void AddPose(const TimedPose& pose) {
    const bot_core::rigid_transform_t message = ToMessage(pose);
    Log(pose_channel_, message);
    WriteClouds(assembler_.AddPose(*FromMessage(message).pose));
  }

  void AddLine(const ScannedLine& line) {
    const bot_core::planar_lidar_t message = ToMessage(line.line);
    Log(laser_channel_, message);
    ++result_.num_lines;
    if (truth_) truth_->Add(line);
    WriteClouds(assembler_.AddLine(*FromMessage(message).line));
  }

  void EndSweep(int sweep) {
    if (!truth_) return;
    truths_.push_back({SweepName(scene_, files_, sweep, num_sweeps_), truth_->Take()});
  }

  SweepFilesResult Finish() {
    WriteClouds(assembler_.Finish());
    if (log_) Complain(log_->Close());
    if (truth_) Complain(WriteFileAtomically(files_.truth, TruthJson(truths_)));
    return std::move(result_);
  }

  SweepFilesResult Abandon() {
    result_.stopped = true;
    return std::move(result_);
  }

 private:
  template <typename Message>
  void Log(const std::string& channel, const Message& message) {
    if (!log_) return;
    const std::vector<std::uint8_t> bytes = EncodeMessage(message);
    log_->Write(message.utime, channel, bytes.data(), bytes.size());
  }

  void WriteClouds(const std::vector<Sweep>& sweeps) {
    for (const Sweep& sweep : sweeps) {
      const int number = static_cast<int>(result_.num_points.size());
      result_.num_points.push_back(sweep.scan.points.size());
      if (files_.pcd.empty()) continue;
      const std::string path = NumberedPath(files_.pcd, number, num_sweeps_);
      Complain(sweep.complete() ? WritePcd(path, sweep.scan)
                                : path + ": not written: " + sweep.incomplete_reason);
    }
  }

  void Complain(const std::string& error) {
    if (!error.empty()) result_.errors.push_back(error);
  }

  const Scene& scene_;
  int num_sweeps_;
  std::string laser_channel_, pose_channel_;
  const SweepFiles& files_;
  SweepAssembler assembler_;
  std::optional<EventLogWriter> log_;
  std::optional<GroundTruth> truth_;
  std::vector<ScanTruth> truths_;
  SweepFilesResult result_;
};

// The whole of one sweep from one place.
std::optional<Scan> ScanOnce(const Scene& scene, const Sensor& sensor, const RayCaster& caster,
                             std::uint64_t seed, const SweepParams& params,
                             const std::atomic<bool>& stop) {
  const LaserScanner scanner(sensor, scene.noise, caster, seed, scene.start_utime);
  SweepAssembler assembler(params);
  for (int line = 0; line < scanner.num_lines(); ++line) {
    if (stop) return std::nullopt;
    assembler.AddPose(scanner.TimedPoseOf(line));
    assembler.AddLine(scanner.Scan(line).line);
  }
  std::vector<Sweep> sweeps = assembler.AddPose(scanner.TimedPoseOf(scanner.num_lines()));
  if (sweeps.empty()) sweeps = assembler.Finish();
  if (sweeps.empty() || !sweeps.front().complete()) return std::nullopt;
  return std::move(sweeps.front().scan);
}

const SceneObject* OnlyObjectOfAClass(const Scene& scene) {
  const SceneObject* found = nullptr;
  for (const SceneObject& object : scene.objects) {
    if (object.class_name.empty()) continue;
    if (found != nullptr) return nullptr;
    found = &object;
  }
  return found;
}

}  // namespace

SweepParams SweepParamsFor(const Sensor& sensor, SweepParams base) {
  base.line_duration = sensor.line_period;
  base.beams_per_line = sensor.num_beams;
  base.max_range = sensor.max_range;
  base.min_range = std::min(base.min_range, 0.5 * sensor.max_range);
  base.max_pose_gap = std::max(base.max_pose_gap, 1.5 * sensor.line_period);
  const double turned = std::abs(sensor.tilt_end - sensor.tilt_start);
  base.min_sweep_angle = std::min(base.min_sweep_angle, std::max(0.5 * turned, 1e-6));
  // Short sweeps turn back after less than the usual angle.
  base.reversal_angle = std::min(base.reversal_angle, std::max(0.25 * turned, 1e-6));
  return base;
}

SweepFilesResult WriteSweeps(const Scene& scene, int num_sweeps, const Channels& channels,
                             const SweepParams& params, const SweepFiles& files,
                             const std::atomic<bool>& stop) {
  const RayCaster caster(scene.objects);
  const LaserScanner scanner(scene.sensor, scene.noise, caster, scene.seed, scene.start_utime);
  SweepWriter writer(scene, num_sweeps, channels, params, files);
  std::int64_t line = 0;
  for (int sweep = 0; sweep < num_sweeps; ++sweep) {
    const bool last = sweep + 1 == num_sweeps;
    const int num_lines = last ? scanner.num_lines() : scanner.LinesPerSweep();
    for (int i = 0; i < num_lines; ++i, ++line) {
      if (stop) return writer.Abandon();
      const ScannedLine scanned = scanner.Scan(line);
      writer.AddPose(scanner.TimedPoseOf(line));
      writer.AddLine(scanned);
      if (i + 1 == scanner.num_lines()) writer.EndSweep(sweep);
    }
  }
  writer.AddPose(scanner.TimedPoseOf(line));
  return writer.Finish();
}

std::vector<Sensor> RecordingSensors(const Scene& scene, const SceneObject& object) {
  const Eigen::Vector3d centre = ObjectFrameOf(object).T_scene_object.translation();
  const Eigen::Vector2d from_object = (scene.sensor.position - centre).head<2>();
  const RecordingPlan& plan = scene.recording;
  const double distance = plan.distance > 0.0 ? plan.distance : from_object.norm();
  constexpr double kLeastDistance = 0.01;  // m
  if (distance < kLeastDistance) {
    throw std::invalid_argument(
        "the sensor stands in the object: set recording.distance or move the sensor");
  }
  const double first =
      from_object.norm() < kLeastDistance ? 0.0 : std::atan2(from_object.y(), from_object.x());
  std::vector<Sensor> sensors;
  for (int i = 0; i < plan.num_views; ++i) {
    const double angle = first + 2.0 * M_PI * i / plan.num_views;
    Sensor sensor = scene.sensor;
    sensor.position.x() = centre.x() + distance * std::cos(angle);
    sensor.position.y() = centre.y() + distance * std::sin(angle);
    if (!plan.heights.empty()) sensor.position.z() = plan.heights[i % plan.heights.size()];
    sensor.yaw = std::remainder(angle + M_PI, 2.0 * M_PI);
    sensors.push_back(sensor);
  }
  return sensors;
}

std::string WriteRecording(const Scene& scene, const SweepParams& params, const std::string& folder,
                           const std::atomic<bool>& stop) {
  const SceneObject* const object = OnlyObjectOfAClass(scene);
  if (object == nullptr) {
    return "a recording needs a scene in which exactly one object has a class";
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return folder + ": " + error.message();
  const RayCaster caster(scene.objects);
  const std::vector<Sensor> sensors = RecordingSensors(scene, *object);
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    // Other viewpoints, other noise.
    const std::optional<Scan> scan =
        ScanOnce(scene, sensors[i], caster, scene.seed + i, params, stop);
    if (stop) return kStopped;
    char name[32];
    std::snprintf(name, sizeof(name), "scan_%03zu.pcd", i);
    const std::string path = (std::filesystem::path(folder) / name).string();
    if (!scan) return path + ": the scene's sensor makes no complete sweep";
    const std::string failure = WritePcd(path, *scan);
    if (!failure.empty()) return failure;
  }
  return WriteFileAtomically((std::filesystem::path(folder) / "model.json").string(),
                             ModelJson(*object));
}

}  // namespace rimod::simulation
