#include "detector_proc/extractor_process.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <limits>
#include <utility>

#include "detector_proc/projection_text.h"
#include "io/cloud_messages.h"
#include "io/feature_messages.h"
#include "io/laser_messages.h"
#include "io/partial_messages.h"
#include "io/range_image_messages.h"
#include "io/stage_timer.h"
#include "io/status_counters.h"
#include "io/stoppable.h"
#include "rimod/detector.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

// The handler only joins sections, so that few wait; some whole scans may.
constexpr int kQueueCapacity = 1000;

// Clouds may have megabytes. The handler takes milliseconds, and what it cannot take is lost
// without being counted: ten seconds of a fast sensor.
constexpr int kCloudQueueCapacity = 100;

constexpr std::int64_t kNoScan = std::numeric_limits<std::int64_t>::min();

// Without points.
StampedScan StampOf(const StampedScan& scan) {
  return {scan.utime, scan.utime_end, scan.num_lines, scan.num_missing_lines, {}};
}

bool IsSameScan(const StampedScan& a, const StampedScan& b) {
  return a.utime == b.utime && a.utime_end == b.utime_end && a.num_lines == b.num_lines;
}

}  // namespace

ExtractorProcess::ExtractorProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                                   const Configuration& configuration, int num_threads,
                                   const CloudChannels& clouds, const Tempo& tempo)
    : tempo_(tempo),
      channels_(channels),
      params_(configuration.pipeline),
      growing_extractor_(params_),
      pool_(num_threads),
      joiner_(JoinerParamsFrom(configuration.bus)),
      partial_joiner_(JoinerParamsFrom(configuration.bus)),
      patience_(static_cast<int>(1e3 * configuration.bus.join_patience)),
      placer_(params_.cloud, !clouds.poses.empty()),
      status_(out, channels.status, "rimod-extractor", tempo),
      senders_(in, channels.status, {channels.range_image, channels.features}, &status_),
      publisher_(out, configuration.bus, tempo),
      last_scan_(kNoScan),
      worker_(
          configuration.bus.max_waiting_scans,
          // Scans wait here, where the newest wins, and not as messages that nobody overtakes.
          [this] { publisher_.Flush(); }, [this](const Job& job) { Work(job); }, tempo.at_once()) {
  const SubscriptionObserver observer = status_.MakeObserver();
  subscriptions_.push_back(
      SubscribeTo<scan_t>(in, channels.scan, kQueueCapacity, observer,
                          [this](scan_t section) { return OnSection(std::move(section)); }));
  subscriptions_.push_back(SubscribeTo<partial_scan_t>(
      in, channels.partial_scan, kQueueCapacity, observer,
      [this](partial_scan_t section) { return OnPartialSection(std::move(section), true); }));
  subscriptions_.push_back(SubscribeTo<partial_scan_t>(
      in, channels.scan_ahead, kQueueCapacity, observer,
      [this](partial_scan_t section) { return OnPartialSection(std::move(section), false); }));
  subscriptions_.push_back(
      SubscribeTo<scan_end_t>(in, channels.scan_end, kQueueCapacity, observer,
                              [this](const scan_end_t& message) { return OnScanEnd(message); }));
  SubscribeToClouds(in, clouds);
}

ExtractorProcess::~ExtractorProcess() { stop_ = true; }

void ExtractorProcess::SubscribeToClouds(lcm::LCM* in, const CloudChannels& clouds) {
  if (clouds.clouds.empty()) return;
  takes_clouds_ = true;
  const SubscriptionObserver observer = status_.MakeObserver();
  subscriptions_.push_back(SubscribeTo<bot_core::pointcloud2_t>(
      in, clouds.clouds, kCloudQueueCapacity, observer,
      [this](const bot_core::pointcloud2_t& message) { return OnCloud(message); }));
  if (clouds.poses.empty()) return;
  subscriptions_.push_back(SubscribeTo<bot_core::rigid_transform_t>(
      in, clouds.poses, kQueueCapacity, observer,
      [this](const bot_core::rigid_transform_t& message) { return OnCloudPose(message); }));
}

std::string ExtractorProcess::OnSection(scan_t section) {
  const auto sections = joiner_.Add(std::move(section), tempo_.Now());
  if (!sections) return "";
  JoinedScan joined = JoinScanSections(*sections);
  if (!joined.scan) return joined.error;
  if (IsKnownAlready(*joined.scan)) return "";
  last_given_ = StampOf(*joined.scan);
  repetition_until_.reset();
  Give(std::move(*joined.scan));
  return "";
}

// Once only: who replays a scan wants it to be worked on again.
bool ExtractorProcess::IsKnownAlready(const StampedScan& scan) {
  if (!repetition_until_ || tempo_.Now() > *repetition_until_ || !IsSameScan(scan, *last_given_))
    return false;
  repetition_until_.reset();
  return true;
}

std::string ExtractorProcess::OnPartialSection(partial_scan_t section, bool look) {
  const auto sections = partial_joiner_.Add(std::move(section.section), tempo_.Now());
  if (!sections) return "";
  const JoinedSweepGrowth joined = SweepGrowthFrom(section.utime, section.step, *sections);
  if (!joined.growth) return joined.error;
  if (joined.growth->step == 0) last_given_.reset();
  if (!growing_.Add(*joined.growth)) return "";  // a step is missing: the scan itself will come
  GiveWhenWhole();
  if (!look) return "";
  StampedScan scan;
  scan.utime = growing_.sweep_begin().count();
  scan.utime_end = growing_.end().count();
  scan.scan = *growing_.scan();
  num_partial_overtaken_ += worker_.GiveWhenIdle({/*is_partial=*/true, std::move(scan)});
  return "";
}

std::string ExtractorProcess::OnScanEnd(const scan_end_t& message) {
  const SweepEndFromMessage end = FromMessage(message);
  if (!end.end) return end.error;
  sweep_end_ = *end.end;
  GiveWhenWhole();
  return "";
}

void ExtractorProcess::GiveWhenWhole() {
  if (!sweep_end_ || !growing_.IsWhole(*sweep_end_)) return;
  StampedScan scan = {sweep_end_->begin.count(), sweep_end_->end.count(), sweep_end_->num_lines,
                      sweep_end_->num_missing_lines, *growing_.scan()};
  scan.scan.T_local_sensor = sweep_end_->T_local_sensor;
  sweep_end_.reset();
  if (last_given_ && IsSameScan(scan, *last_given_)) return;
  ++num_ahead_;
  last_given_ = StampOf(scan);
  repetition_until_ = tempo_.Now() + patience_;
  Give(std::move(scan));
}

std::string ExtractorProcess::OnCloud(const bot_core::pointcloud2_t& message) {
  SensorCloudFromMessage cloud = FromMessage(message);
  if (!cloud.cloud) return cloud.error;
  Give(placer_.AddCloud(std::move(*cloud.cloud)));
  return "";
}

std::string ExtractorProcess::OnCloudPose(const bot_core::rigid_transform_t& message) {
  const TimedPoseFromMessage pose = FromMessage(message);
  if (!pose.pose) return pose.error;
  Give(placer_.AddPose(*pose.pose));
  return "";
}

void ExtractorProcess::Give(std::vector<PlacedCloud> clouds) {
  for (PlacedCloud& cloud : clouds) {
    StampedScan scan;
    scan.utime = scan.utime_end = cloud.time.count();
    scan.scan = std::move(cloud.scan);
    Give(std::move(scan));
  }
}

void ExtractorProcess::Give(StampedScan scan) {
  last_scan_ = scan.utime;
  status_.CountDropped("scans overtaken", worker_.Give({/*is_partial=*/false, std::move(scan)}));
}

void ExtractorProcess::Work(const Job& job) try {
  if (job.is_partial) {
    WorkOnPartial(job.scan);
  } else {
    WorkOnScan(job.scan);
  }
} catch (const Stopped&) {
  // The process ends, or a whole scan came in: this one is left undone.
  if (job.is_partial) ++num_partial_overtaken_;
} catch (const std::exception& error) {
  status_.CountDropped("scans failed");
  status_.ReportError(error.what(), "scan " + std::to_string(job.scan.utime) + ": " + error.what());
}

void ExtractorProcess::WorkOnScan(const StampedScan& scan) {
  const auto begin = Clock::now();
  growing_extractor_.Forget();  // the sweep has ended
  StageTimer timer;
  Execution execution = pool_.MakeExecution();
  timer.Watch(&execution);
  execution = StoppableExecution(std::move(execution), &stop_);

  const RangeImage image = ComputeRangeImage(scan.scan, params_, execution);
  TellProjection(image);
  publisher_.PublishAll(channels_.range_image, ToSections(image, scan.utime));
  const FeatureSet features = ExtractFeatures(image, params_, execution);
  publisher_.PublishAll(channels_.features, ToSections(features, scan.utime));

  const std::chrono::duration<double, std::milli> total = Clock::now() - begin;
  timer.Add("total", total.count());
  status_.AddStageTimes(timer.times());
  tempo_.TellStageTimes(scan.utime, timer.times());
  status_.CountOut();
  spdlog::info("scan {}: {} points, {} features, {:.0f} ms", scan.utime, scan.scan.points.size(),
               features.features.size(), total.count());
}

// Once a change.
void ExtractorProcess::TellProjection(const RangeImage& image) {
  if (image.grid().size() == 0) return;
  const bool too_wide = IsTooWideForPinhole(image, params_.range_image);
  if (too_wide) ++num_too_wide_;
  if (too_wide == was_too_wide_) return;
  was_too_wide_ = too_wide;
  if (too_wide) {
    spdlog::warn(kTooWideText);
  } else {
    spdlog::info("range images are pinhole images again");
  }
}

void ExtractorProcess::WorkOnPartial(const StampedScan& scan) {
  if (last_scan_ == scan.utime) throw Stopped();
  const auto begin = Clock::now();
  const Execution execution =
      StoppableExecution(StoppableExecution(pool_.MakeExecution(), &stop_), &worker_.wanted());
  const RangeImage image = ComputeRangeImage(scan.scan, params_, execution);
  const FeatureSet features = growing_extractor_.Look(Time(scan.utime), image, execution);
  if (last_scan_ == scan.utime) throw Stopped();
  publisher_.PublishAll(channels_.partial_range_image,
                        ToPartialSections(image, scan.utime, scan.utime_end));
  publisher_.PublishAll(channels_.partial_features,
                        ToPartialSections(features, scan.utime, scan.utime_end));
  ++num_partial_out_;
  const std::chrono::duration<double, std::milli> total = Clock::now() - begin;
  const StageTimes times = {{"partial_total", total.count()}};
  status_.AddStageTimes(times);
  tempo_.TellStageTimes(scan.utime, times);
}

void ExtractorProcess::OnIdle() {
  joiner_.GiveUpStale(tempo_.Now());
  partial_joiner_.GiveUpStale(tempo_.Now());
  status_.SetSectionCounters("scan", joiner_.counters());
  status_.SetCounter("scans known ahead", num_ahead_);
  status_.SetCounter("partial scans described", num_partial_out_);
  if (params_.range_image.projection == Projection::kPinhole)
    status_.SetCounter("scans too wide for a pinhole", num_too_wide_);
  status_.SetCounter("partial scans overtaken", num_partial_overtaken_);
  if (takes_clouds_) ReportClouds();
  status_.SetCounter("unsent messages", publisher_.num_failed());
  status_.SetGauge(kWaitingScansCounter, static_cast<std::int64_t>(worker_.num_waiting()));
  status_.SetGauge(kWaitingMessagesCounter, publisher_.num_waiting());
  senders_.Report(tempo_.Now());
  status_.PublishIfDue();
}

void ExtractorProcess::ReportClouds() {
  const CloudCounters& counters = placer_.counters();
  status_.SetCounter("clouds", counters.clouds);
  status_.SetCounter("bad clouds", counters.bad_clouds, true);
  status_.SetCounter("unordered clouds", counters.unordered_clouds, true);
  status_.SetCounter("clouds without pose", counters.clouds_without_pose, true);
  status_.SetCounter("bad poses", counters.bad_poses);
  status_.SetCounter("unordered poses", counters.unordered_poses);
}

}  // namespace rimod
