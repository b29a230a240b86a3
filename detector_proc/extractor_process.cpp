#include "detector_proc/extractor_process.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

#include "io/feature_messages.h"
#include "io/range_image_messages.h"
#include "io/stage_timer.h"
#include "io/stoppable.h"
#include "rimod/detector.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

// The handler only joins sections, so that few wait; some whole scans may.
constexpr int kQueueCapacity = 1000;

}  // namespace

ExtractorProcess::ExtractorProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                                   const Configuration& configuration, int num_threads)
    : channels_(channels),
      params_(configuration.pipeline),
      pool_(num_threads),
      joiner_(JoinerParamsFrom(configuration.bus)),
      status_(out, channels.status, "rimod-extractor"),
      publisher_(out, configuration.bus),
      worker_(
          configuration.bus.max_waiting_scans, [] {},
          [this](const StampedScan& scan) { Work(scan); }) {
  subscription_ =
      SubscribeTo<scan_t>(in, channels.scan, kQueueCapacity, status_.MakeObserver(),
                          [this](scan_t section) { return OnSection(std::move(section)); });
}

ExtractorProcess::~ExtractorProcess() { stop_ = true; }

std::string ExtractorProcess::OnSection(scan_t section) {
  const auto sections = joiner_.Add(std::move(section), Clock::now());
  if (!sections) return "";
  JoinedScan joined = JoinScanSections(*sections);
  if (!joined.scan) return joined.error;
  status_.CountDropped("scans overtaken", worker_.Give(std::move(*joined.scan)));
  return "";
}

void ExtractorProcess::Work(const StampedScan& scan) try {
  const auto begin = Clock::now();
  StageTimer timer;
  Execution execution = pool_.MakeExecution();
  timer.Watch(&execution);
  execution = StoppableExecution(std::move(execution), &stop_);

  const RangeImage image = ComputeRangeImage(scan.scan, params_, execution);
  publisher_.PublishAll(channels_.range_image, ToSections(image, scan.utime));
  const FeatureSet features = ExtractFeatures(image, params_, execution);
  publisher_.PublishAll(channels_.features, ToSections(features, scan.utime));

  const std::chrono::duration<double, std::milli> total = Clock::now() - begin;
  timer.Add("total", total.count());
  status_.AddStageTimes(timer.times());
  status_.CountOut();
  spdlog::info("scan {}: {} points, {} features, {:.0f} ms", scan.utime, scan.scan.points.size(),
               features.features.size(), total.count());
} catch (const Stopped&) {
  // The process ends: the scan is left undone.
} catch (const std::exception& error) {
  status_.CountDropped("scans failed");
  status_.ReportError(error.what(), "scan " + std::to_string(scan.utime) + ": " + error.what());
}

void ExtractorProcess::OnIdle() {
  joiner_.GiveUpStale(Clock::now());
  status_.SetSectionCounters("scan", joiner_.counters());
  status_.SetCounter("unsent messages", publisher_.num_failed());
  status_.PublishIfDue();
}

}  // namespace rimod
