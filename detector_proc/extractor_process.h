#pragma once

#include <atomic>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>

#include "io/channels.h"
#include "io/config.h"
#include "io/newest_worker.h"
#include "io/paced_publisher.h"
#include "io/raw_subscription.h"
#include "io/scan_messages.h"
#include "io/section_joiner.h"
#include "io/status_reporter.h"
#include "io/thread_pool.h"

namespace rimod {

// Scans in, their range images and features out.
class ExtractorProcess {
 public:
  // Both LCM instances (they may be one) must outlive the process. num_threads: of the computation,
  // 0 for as many as the machine has.
  ExtractorProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                   const Configuration& configuration, int num_threads);
  // Breaks off the computation at hand.
  ~ExtractorProcess();

  // To be called many times a second: reports.
  void OnIdle();

 private:
  std::string OnSection(scan_t section);
  void Work(const StampedScan& scan);

  const Channels channels_;
  const PipelineParams params_;
  std::atomic<bool> stop_{false};
  ThreadPool pool_;
  SectionJoiner<scan_t> joiner_;
  StatusReporter status_;
  PacedPublisher publisher_;
  NewestWorker<StampedScan> worker_;
  std::unique_ptr<BytesSubscription> subscription_;
};

}  // namespace rimod
