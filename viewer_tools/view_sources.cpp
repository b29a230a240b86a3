#include "viewer_tools/view_sources.h"

#include <chrono>
#include <exception>
#include <map>
#include <optional>
#include <utility>

#include "io/event_log.h"
#include "io/files.h"
#include "io/scan_source.h"
#include "io/stoppable.h"
#include "io/thread_pool.h"
#include "rimod/detector.h"
#include "viewer_tools/scan_follower.h"

namespace rimod {
namespace {

bool HasRangeImages(const std::string& path, const Channels& channels) {
  if (!IsEventLog(path)) return false;
  EventLogReader log(path);
  while (const std::optional<LogEvent> event = log.Next())
    if (event->channel == channels.range_image || event->channel == channels.partial_range_image)
      return true;
  return false;
}

ViewSourceReport ReadRecorded(const std::string& path, const Channels& channels,
                              const BusParams& params,
                              const std::function<bool(ViewedScan)>& on_scan) {
  ViewSourceReport report;
  std::map<std::string, int> rejected;  // by channel and cause
  ScanFollower follower(channels, params);
  EventLogReader log(path);
  bool goes_on = true;
  const auto deliver = [&](std::vector<ViewedScan> scans) {
    for (ViewedScan& scan : scans) {
      if (!goes_on) return;
      scan.name = FileStem(path) + ", scan " + std::to_string(scan.utime);
      ++report.num_scans;
      goes_on = on_scan(std::move(scan));
    }
  };
  while (goes_on) {
    const std::optional<LogEvent> event = log.Next();
    if (!event) break;
    const ScanFollower::Clock now{std::chrono::microseconds(event->utime)};
    const std::string error =
        follower.Take(event->channel, event->bytes.data(), event->bytes.size(), now);
    if (!error.empty()) ++rejected[event->channel + ": " + error];
    deliver(follower.TakeFinished());
  }
  deliver(follower.TakeRest());
  if (!log.error().empty()) report.errors.push_back(log.error());
  for (const auto& [cause, count] : rejected)
    report.errors.push_back(path + ": " + std::to_string(count) + " message(s) left out, " + cause);
  return report;
}

// Runs the stages on scans.
class Stages {
 public:
  Stages(const PipelineParams& params, const std::vector<ObjectModel>& models)
      : params_(params), pool_(0) {
    if (!models.empty()) database_.emplace(models, params_, pool_.MakeExecution());
  }

  ViewedScan Run(const NamedScan& named) {
    const Execution execution = pool_.MakeExecution();
    ViewedScan viewed;
    viewed.name = named.name;
    viewed.utime = named.utime;
    viewed.image = ComputeRangeImage(named.scan, params_, execution);
    viewed.features = ExtractFeatures(*viewed.image, params_, execution);
    if (!database_) return viewed;
    DetectionResult result =
        DetectObjects(*viewed.image, *viewed.features, *database_, params_, execution);
    viewed.hypotheses = {result.num_hypotheses_found, std::move(result.hypotheses)};
    viewed.detections.emplace();
    viewed.detections->utime = named.utime;
    viewed.detections->T_local_sensor = viewed.image->T_local_sensor();
    viewed.detections->num_models = static_cast<int>(database_->models().size());
    viewed.detections->detections = std::move(result.detections);
    return viewed;
  }

 private:
  const PipelineParams& params_;
  ThreadPool pool_;
  std::optional<ModelDatabase> database_;
};

ViewSourceReport ReadUnprocessed(const std::string& path, const PipelineParams& params,
                                 const std::vector<ObjectModel>& models,
                                 const std::function<bool(ViewedScan)>& on_scan) {
  ViewSourceReport report;
  Stages stages(params, models);
  ScanSourceReport read;
  try {
    read = ReadScans(path, params.sweep, [&](const NamedScan& scan) {
      ++report.num_scans;
      if (!on_scan(stages.Run(scan))) throw Stopped();
    });
  } catch (const Stopped&) {
    return report;  // nobody wants the rest
  }
  report.errors = std::move(read.errors);
  report.warnings = std::move(read.warnings);
  return report;
}

}  // namespace

ViewSourceReport ReadViewedScans(const std::string& path, const Channels& channels,
                                 const Configuration& configuration,
                                 const std::vector<ObjectModel>& models,
                                 const std::function<bool(ViewedScan)>& on_scan) {
  if (HasRangeImages(path, channels))
    return ReadRecorded(path, channels, configuration.bus, on_scan);
  return ReadUnprocessed(path, configuration.pipeline, models, on_scan);
}

}  // namespace rimod
