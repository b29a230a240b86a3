// Looks at the growing scans of logs as extractor and matcher do, and writes what is told early and
// what is found in the end: experiments/early_detection.py makes a table of it.

#include <CLI/CLI.hpp>
#include <chrono>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/config.h"
#include "io/model_file.h"
#include "io/pose_messages.h"
#include "io/scan_source.h"
#include "io/stage_timer.h"
#include "io/thread_pool.h"
#include "rimod/detector.h"
#include "rimod/early_detection.h"
#include "rimod/growing_look.h"
#include "rimod/growing_scan.h"

namespace rimod {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string models, config, out;
  std::vector<std::string> logs;
  int num_threads = 0;
};

Json ToJson(const Detection& detection) {
  const Eigen::Vector3d p = detection.T_local_object.translation();
  const std::array<double, 4> q = QuaternionOf(detection.T_local_object);
  return {{"class", detection.class_name},
          {"pose", {p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]}},
          {"score", detection.score}};
}

Json ToJson(const std::vector<EarlyObject>& objects) {
  const char* const names[] = {"new", "confirmed", "unseen", "withdrawn"};
  Json list = Json::array();
  for (const EarlyObject& object : objects) {
    Json json = ToJson(object.detection);
    json["id"] = object.id;
    json["status"] = names[static_cast<int>(object.status)];
    json["unseen"] = object.unseen_share;
    list.push_back(std::move(json));
  }
  return list;
}

// Works through logs; one JSON object a scan.
class Watcher {
 public:
  Watcher(const ModelDatabase& database, const PipelineParams& params, Execution execution,
          std::ostream* out)
      : database_(database),
        params_(params),
        execution_(std::move(execution)),
        extractor_(params),
        detector_(database, params),
        tracker_(params.early),
        out_(out) {}

  void OnGrowth(const SweepGrowth& growth) {
    if (!growing_.Add(growth)) return;
    const auto begin = Clock::now();
    StageTimer timer;
    Execution execution = execution_;
    timer.Watch(&execution);
    Look look;
    look.image = ComputeRangeImage(*growing_.scan(), params_, execution);
    const FeatureSet features = extractor_.Look(growing_.sweep_begin(), look.image, execution);
    look.result = detector_.Look(growing_.sweep_begin(), look.image, features, execution);
    const std::vector<EarlySighting> sightings =
        SightingsOf(look.result.detections, look.image, database_);
    const std::vector<EarlyObject> told =
        tracker_.Update(growing_.sweep_begin(), growing_.end(), sightings);
    Json seen = Json::array();
    for (const EarlySighting& sighting : sightings) {
      seen.push_back(ToJson(sighting.detection));
      seen.back()["unseen"] = sighting.unseen_share;
    }
    looks_[growing_.sweep_begin().count()].push_back({{"known_until", growing_.end().count()},
                                                      {"ms", MillisecondsSince(begin)},
                                                      {"stages", timer.times()},
                                                      {"sightings", std::move(seen)},
                                                      {"told", ToJson(told)}});
  }

  void OnScan(const NamedScan& scan) {
    const auto begin = Clock::now();
    const Look look = LookAt(scan.scan);
    const double ms = MillisecondsSince(begin);
    const std::vector<EarlyObject> objects =
        tracker_.Finish(Time(scan.utime), Time(scan.utime_end), look.result.detections);
    *out_ << Json{{"scan", scan.name}, {"begin", scan.utime},         {"end", scan.utime_end},
                  {"ms", ms},          {"looks", looks_[scan.utime]}, {"final", ToJson(objects)}}
          << std::endl;
    looks_.erase(scan.utime);
  }

 private:
  using Clock = std::chrono::steady_clock;
  struct Look {
    RangeImage image;
    DetectionResult result;
  };

  static double MillisecondsSince(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  }

  Look LookAt(const Scan& scan) const {
    Look look;
    look.image = ComputeRangeImage(scan, params_, execution_);
    const FeatureSet features = ExtractFeatures(look.image, params_, execution_);
    look.result = DetectObjects(look.image, features, database_, params_, execution_);
    return look;
  }

  const ModelDatabase& database_;
  const PipelineParams& params_;
  Execution execution_;
  GrowingScan growing_;
  GrowingExtractor extractor_;
  GrowingDetector detector_;
  EarlyTracker tracker_;
  std::map<std::int64_t, Json> looks_;  // by the sweep's utime
  std::ostream* out_;
};

int Run(const Options& options) {
  const ConfigurationResult read = ReadConfiguration(options.config);
  ModelFolder folder = LoadModelFolder(options.models);
  if (!read.configuration || !folder.error.empty()) {
    std::cerr << read.error << folder.error << '\n';
    return 1;
  }
  const PipelineParams& params = read.configuration->pipeline;
  ThreadPool pool(options.num_threads);
  const ModelDatabase database(std::move(folder.models), params, pool.MakeExecution());
  std::ofstream out(options.out);
  Watcher watcher(database, params, pool.MakeExecution(), &out);
  ScanSourceParams source;
  source.sweep = params.sweep;
  source.growth_period = params.early.period;
  source.on_growth = [&watcher](const SweepGrowth& growth) { watcher.OnGrowth(growth); };
  bool good = true;
  for (const std::string& path : options.logs) {
    const ScanSourceReport report =
        ReadScans(path, source, [&watcher](const NamedScan& scan) { watcher.OnScan(scan); });
    for (const std::string& error : report.errors) std::cerr << error << '\n';
    good = good && report.errors.empty();
  }
  return good && out.good() ? 0 : 1;
}

}  // namespace
}  // namespace rimod

int main(int argc, char** argv) {
  CLI::App app(
      "Writes what is told of objects before the sweeps of logs have ended, as JSON lines.");
  rimod::Options options;
  app.add_option("--models", options.models, "Folder with .rimod files")->required();
  app.add_option("--config", options.config, "Configuration file");
  app.add_option("--threads", options.num_threads, "Threads that compute; 0: all");
  app.add_option("--out", options.out, "JSON lines to write")->required();
  app.add_option("logs", options.logs, "LCM logs with LASER and LASER_TO_LOCAL")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return rimod::Run(options);
}
