#include "viewer_tools/report_sources.h"

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/files.h"
#include "io/scan_source.h"
#include "rimod/detector.h"
#include "viewer_tools/recorded_scans.h"

namespace rimod {
namespace {

using Json = nlohmann::ordered_json;

// Adds the stages of all processes up.
StageTimes JoinTimes(const std::vector<ProcessTimes>& processes) {
  StageTimes joined;
  for (const ProcessTimes& process : processes)
    joined.insert(joined.end(), process.stage_times.begin(), process.stage_times.end());
  return joined;
}

SourceReport ReadRecorded(const std::string& path, const Channels& channels, int num_scans,
                          const StageTimes& stage_times,
                          const std::function<void(SourceScan)>& on_scan) {
  SourceReport report;
  int number = 0;
  int num_without_image = 0;
  const RecordedScansReport read =
      ReadRecordedScans(path, channels, WantedImages::kAll, [&](RecordedScan recorded) {
        std::string name = FileStem(path);
        if (num_scans > 1) name += "#" + std::to_string(number);
        ++number;
        if (!recorded.image) {
          ++num_without_image;
          return;
        }
        ++report.num_scans;
        on_scan({std::move(name), std::move(*recorded.image),
                 std::move(recorded.detections.detections), stage_times});
      });
  report.errors = read.errors;
  if (num_without_image > 0)
    report.errors.push_back(path + ": " + std::to_string(num_without_image) +
                            " scan(s) have detections but no whole range image");
  if (num_scans > 1 && !stage_times.empty())
    report.warnings.push_back(path + ": its stage times are those of the last scans");
  return report;
}

SourceReport ReadUnprocessed(const std::string& path, const PipelineParams& params,
                             const std::function<void(SourceScan)>& on_scan) {
  SourceReport report;
  const ScanSourceReport read = ReadScans(path, params.sweep, [&](const NamedScan& scan) {
    SourceScan source;
    Execution execution;
    StageTimer timer;
    timer.Watch(&execution);
    if (scan.from_log) timer.Add("assembly", scan.assembly_ms);
    source.name = scan.name;
    source.image = ComputeRangeImage(scan.scan, params, execution);
    source.stage_times = timer.times();
    ++report.num_scans;
    on_scan(std::move(source));
  });
  report.errors = read.errors;
  report.warnings = read.warnings;
  return report;
}

}  // namespace

SourceReport ReadSource(const std::string& path, const Channels& channels,
                        const PipelineParams& params, bool use_recorded_detections,
                        const std::function<void(SourceScan)>& on_scan) {
  if (use_recorded_detections) {
    const RecordedScansReport recorded =
        ReadRecordedScans(path, channels, WantedImages::kNone, [](const RecordedScan&) {});
    if (recorded.num_scans > 0)
      return ReadRecorded(path, channels, recorded.num_scans, JoinTimes(recorded.process_times),
                          on_scan);
  }
  return ReadUnprocessed(path, params, on_scan);
}

TimingFile ReadTimingFile(const std::string& path) {
  constexpr std::int64_t kMaxBytes = 256'000'000;
  const FileBytes file = ReadFile(path, kMaxBytes);
  if (!file.bytes) return {{}, file.error};
  const Json json = Json::parse(*file.bytes, nullptr, /*allow_exceptions=*/false);
  if (!json.is_array()) return {{}, path + ": is not a JSON array of stage times"};
  TimingFile timing;
  for (const Json& entry : json) {
    if (!entry.is_object() || !entry.contains("scan") || !entry["scan"].is_string() ||
        !entry.contains("ms") || !entry["ms"].is_object())
      return {{}, path + ": an entry has no \"scan\" or no \"ms\""};
    StageTimes& times = timing.times[entry["scan"].get<std::string>()];
    for (const auto& [stage, ms] : entry["ms"].items()) {
      if (!ms.is_number() || !(ms.get<double>() >= 0.0) || !std::isfinite(ms.get<double>()))
        return {{}, path + ": the time of a stage is not a number of milliseconds"};
      times.emplace_back(stage, ms.get<double>());
    }
  }
  return timing;
}

}  // namespace rimod
