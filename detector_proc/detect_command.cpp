#include "detector_proc/detect_command.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <exception>
#include <nlohmann/json.hpp>
#include <ostream>

#include "detector_proc/projection_text.h"
#include "io/files.h"
#include "io/model_file.h"
#include "io/pose_messages.h"
#include "io/scan_source.h"
#include "io/stage_timer.h"
#include "io/thread_pool.h"
#include "rimod/detector.h"

namespace rimod {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr int kDone = 0;
constexpr int kInputFailed = 1;

std::string Text(const Json& json, int indent) {
  // File names need not be UTF-8, JSON must.
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string DetectionLine(const std::string& scan, const Detection& detection) {
  const Eigen::Vector3d p = detection.T_local_object.translation();
  const std::array<double, 4> q = QuaternionOf(detection.T_local_object);
  const Json json = {{"scan", scan},
                     {"class", detection.class_name},
                     {"pose", {p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]}},
                     {"score", detection.score}};
  return Text(json, -1);
}

Json TimingEntry(const NamedScan& scan, const StageTimes& times, double total_ms) {
  Json ms = Json::object();
  if (scan.from_log) ms["assembly"] = scan.assembly_ms;
  for (const auto& [stage, stage_ms] : times) ms[stage] = stage_ms;
  ms["total"] = total_ms;
  return {{"scan", scan.name}, {"points", scan.scan.points.size()}, {"ms", std::move(ms)}};
}

// Works through scans with one set of models.
class Detector {
 public:
  Detector(const ModelDatabase& database, const PipelineParams& params, Execution execution,
           std::ostream* out)
      : database_(database), params_(params), execution_(std::move(execution)), out_(out) {
    timer_.Watch(&execution_);
  }

  void Detect(const NamedScan& scan) {
    timer_.Reset();
    const Clock::time_point begin = Clock::now();
    const RangeImage image = ComputeRangeImage(scan.scan, params_, execution_);
    if (IsTooWideForPinhole(image, params_.range_image) && !told_too_wide_) {
      spdlog::warn("{}: {}", scan.name, kTooWideText);
      told_too_wide_ = true;
    }
    const FeatureSet features = ExtractFeatures(image, params_, execution_);
    const DetectionResult result = DetectObjects(image, features, database_, params_, execution_);
    const std::chrono::duration<double, std::milli> elapsed = Clock::now() - begin;
    for (const Detection& detection : result.detections) {
      *out_ << DetectionLine(scan.name, detection) << '\n';
    }
    out_->flush();  // whoever reads sees each scan when it is done
    const double total_ms = scan.assembly_ms + elapsed.count();
    timing_.push_back(TimingEntry(scan, timer_.times(), total_ms));
    spdlog::info("{}: {} points, {} detections, {:.0f} ms", scan.name, scan.scan.points.size(),
                 result.detections.size(), total_ms);
  }

  const Json& timing() const { return timing_; }

 private:
  const ModelDatabase& database_;
  const PipelineParams& params_;
  Execution execution_;
  std::ostream* out_;
  StageTimer timer_;
  Json timing_ = Json::array();
  bool told_too_wide_ = false;
};

// Reads one source and detects in its scans; false when something of it could not be read.
bool DetectIn(const std::string& path, const ScanSourceParams& params, Detector* detector) {
  bool good = true;
  const auto on_scan = [&](const NamedScan& scan) {
    try {
      detector->Detect(scan);
    } catch (const std::exception& exception) {
      spdlog::error("{}: {}: {}", path, scan.name, exception.what());
      good = false;
    }
  };
  try {
    const ScanSourceReport report = ReadScans(path, params, on_scan);
    for (const std::string& warning : report.warnings) spdlog::warn("{}", warning);
    for (const std::string& error : report.errors) spdlog::error("{}", error);
    return good && report.errors.empty();
  } catch (const std::exception& exception) {  // out of memory
    spdlog::error("{}: {}", path, exception.what());
    return false;
  }
}

// Tells about a models folder; false when something of it could not be read.
bool ReportFolder(const std::string& path, const ModelFolder& folder) {
  for (const std::string& error : folder.bad_files) spdlog::error("{}", error);
  if (!folder.error.empty()) spdlog::error("{}", folder.error);
  if (folder.error.empty() && folder.models.empty()) {
    spdlog::warn("{}: no usable model (*.rimod): nothing will be found", path);
  }
  return folder.error.empty() && folder.bad_files.empty();
}

void TellOtherParams(const std::vector<ObjectModel>& models, const PipelineParams& params) {
  for (const ObjectModel& model : models) {
    if (!ModelMatchesParams(model, params)) {
      spdlog::warn("{}: built with other parameters, its features are computed anew", model.name);
    }
  }
}

}  // namespace

int RunDetect(const DetectOptions& options, const Configuration& configuration, std::ostream& out) {
  const PipelineParams& params = configuration.pipeline;
  ThreadPool pool(options.num_threads);
  ModelFolder folder = LoadModelFolder(options.models, pool.MakeExecution());
  bool good = ReportFolder(options.models, folder);
  if (!folder.error.empty()) return kInputFailed;

  TellOtherParams(folder.models, params);
  const ModelDatabase database(std::move(folder.models), params, pool.MakeExecution());
  Detector detector(database, params, pool.MakeExecution(), &out);
  ScanSourceParams source;
  source.sweep = params.sweep;
  source.cloud = params.cloud;
  source.cloud_channels = options.clouds;
  for (const std::string& path : options.scans) {
    good = DetectIn(path, source, &detector) && good;
  }
  if (!options.timing.empty()) {
    const std::string error =
        WriteFileAtomically(options.timing, Text(detector.timing(), 1) + "\n");
    if (!error.empty()) spdlog::error("{}", error);
    good = good && error.empty();
  }
  if (!out.good()) {
    spdlog::error("the detections could not be written");
    good = false;
  }
  return good ? kDone : kInputFailed;
}

}  // namespace rimod
