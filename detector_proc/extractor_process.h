#pragma once

#include <atomic>
#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bot_core/pointcloud2_t.hpp"
#include "bot_core/rigid_transform_t.hpp"
#include "io/channels.h"
#include "io/config.h"
#include "io/newest_worker.h"
#include "io/paced_publisher.h"
#include "io/raw_subscription.h"
#include "io/scan_messages.h"
#include "io/section_joiner.h"
#include "io/sender_watch.h"
#include "io/status_reporter.h"
#include "io/tempo.h"
#include "io/thread_pool.h"
#include "rimod/cloud_placer.h"
#include "rimod/growing_look.h"
#include "rimod/growing_scan.h"
#include "rimod/partial_scan_t.hpp"
#include "rimod/range_image.h"
#include "rimod/scan_end_t.hpp"

namespace rimod {

// Scans in, their range images and features out. Scans come ready-made, as point clouds of a sensor
// that delivers whole ones, and as what sweeps grow by, which is there sooner. On demand growing
// scans are worked on, too, while there is nothing else to do.
class ExtractorProcess {
 public:
  // Both LCM instances (they may be one) must outlive the process. num_threads: of the computation,
  // 0 for as many as the machine has.
  ExtractorProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                   const Configuration& configuration, int num_threads,
                   const CloudChannels& clouds = {}, const Tempo& tempo = {});
  // Breaks off the computation at hand.
  ~ExtractorProcess();

  // To be called many times a second: reports.
  void OnIdle();

 private:
  // A scan, or what is known of a sweep that still goes on.
  struct Job {
    bool is_partial = false;
    StampedScan scan;  // of a partial one utime is the sweep's, utime_end the last beam so far
  };

  void SubscribeToClouds(lcm::LCM* in, const CloudChannels& clouds);
  std::string OnSection(scan_t section);
  // look: what is known of the sweep is to be described, too.
  std::string OnPartialSection(partial_scan_t section, bool look);
  std::string OnScanEnd(const scan_end_t& message);
  bool IsKnownAlready(const StampedScan& scan);
  void GiveWhenWhole();
  std::string OnCloud(const bot_core::pointcloud2_t& message);
  std::string OnCloudPose(const bot_core::rigid_transform_t& message);
  void Give(StampedScan scan);
  void Give(std::vector<PlacedCloud> clouds);
  void ReportClouds();

  // In the worker's thread:
  void Work(const Job& job);
  void WorkOnScan(const StampedScan& scan);
  void TellProjection(const RangeImage& image);
  void WorkOnPartial(const StampedScan& scan);

  const Tempo tempo_;
  const Channels channels_;
  const PipelineParams params_;
  GrowingExtractor growing_extractor_;  // the worker's
  std::atomic<bool> stop_{false};
  ThreadPool pool_;
  SectionJoiner<scan_t> joiner_;
  SectionJoiner<scan_t> partial_joiner_;
  GrowingScan growing_;
  std::optional<SweepEnd> sweep_end_;      // whose scan has not been made yet of what it grew by
  std::optional<StampedScan> last_given_;  // without points; nothing once another sweep has begun
  // While the last given scan, made of what it grew by, is to come on the channel of scans, too.
  std::optional<std::chrono::steady_clock::time_point> repetition_until_;
  std::int64_t num_ahead_ = 0;  // scans that need not be waited for
  const std::chrono::milliseconds patience_;
  CloudPlacer placer_;
  bool takes_clouds_ = false;
  bool was_too_wide_ = false;  // for a pinhole image; only the worker uses it
  std::atomic<std::int64_t> num_too_wide_{0};
  std::atomic<std::int64_t> num_partial_out_{0};
  std::atomic<std::int64_t> num_partial_overtaken_{0};
  StatusReporter status_;
  SenderWatch senders_;
  PacedPublisher publisher_;
  std::atomic<std::int64_t> last_scan_;  // its utime: growing scans of that sweep are late
  NewestWorker<Job> worker_;
  std::vector<std::unique_ptr<BytesSubscription>> subscriptions_;
};

}  // namespace rimod
