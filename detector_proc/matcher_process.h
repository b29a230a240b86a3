#pragma once

#include <atomic>
#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "detector_proc/shard_speaker.h"
#include "io/channels.h"
#include "io/config.h"
#include "io/early_messages.h"
#include "io/model_split.h"
#include "io/newest_worker.h"
#include "io/paced_publisher.h"
#include "io/partner_joiner.h"
#include "io/raw_subscription.h"
#include "io/section_joiner.h"
#include "io/sender_watch.h"
#include "io/status_reporter.h"
#include "io/tempo.h"
#include "io/thread_pool.h"
#include "io/turn_taker.h"
#include "rimod/detector.h"
#include "rimod/early_detection.h"
#include "rimod/feature_set_t.hpp"
#include "rimod/growing_look.h"
#include "rimod/object_model_t.hpp"
#include "rimod/partial_feature_set_t.hpp"
#include "rimod/partial_range_image_t.hpp"
#include "rimod/range_image_t.hpp"
#include "rimod/shard_turn_t.hpp"

namespace rimod {

// Range images and features in, pose hypotheses and detections of known objects out. Models come at
// the start and, while running, over the bus; a model takes the place of another of its name.
// While there is nothing else to do, sweeps that still go on are looked at, and what is found in
// them is told early.
// As a shard it has a part of the models, and sends what it found of them to the fuser instead, at
// whole scans only.
class MatcherProcess {
 public:
  // Both LCM instances (they may be one) must outlive the process. num_threads: of the computation,
  // 0 for as many as the machine has. models: those of the folder (may be empty: none), which is
  // read again when models come over the bus: keeping them for that would double the memory. share:
  // which of them it takes. A shard needs the default method: throws std::invalid_argument.
  MatcherProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                 const Configuration& configuration, int num_threads, std::string models_folder,
                 std::vector<ObjectModel> models, const ModelShare& share = {},
                 const Tempo& tempo = {});
  // Breaks off the computation at hand.
  ~MatcherProcess();

  // To be called many times a second: reports.
  void OnIdle();

 private:
  void SubscribeToPartials(lcm::LCM* in, const SubscriptionObserver& observer);
  std::string OnRangeImage(range_image_t section);
  std::string OnFeatures(feature_set_t section);
  std::string OnModel(object_model_t section);
  std::string OnPartialRangeImage(partial_range_image_t section);
  std::string OnPartialFeatures(partial_feature_set_t section);
  void Give(std::optional<DescribedScan> scan);
  // As a shard: scans wait for their turn.
  std::string OnTurn(const shard_turn_t& message);
  void GiveForTurn(DescribedScan scan);
  void GiveToWorker(std::optional<DescribedScan> scan);
  void GivePartial(std::int64_t sweep_utime, std::optional<DescribedScan> scan);
  void GiveUpSilentSweep();
  void ReportPartners();
  void ReportTurns();

  enum class JobKind {
    kScan,
    kPartial,  // what is known of a sweep; the scan's utime is the last beam so far
    kGiveUp    // nothing is heard of a sweep any more
  };
  struct Job {
    JobKind kind = JobKind::kScan;
    std::int64_t sweep_utime = 0;
    DescribedScan scan;
  };

  // In the worker's thread:
  void RebuildDatabase();
  void CountModelsOfAllShards(const std::vector<ObjectModel>& of_folder,
                              const std::map<std::string, ObjectModel>& of_bus);
  std::vector<ObjectModel> ModelsOfFolder(const Execution& execution);
  void Work(const Job& job);
  void WorkOnScan(const DescribedScan& scan);
  void WorkAsShard(const DescribedScan& scan);
  void WorkOnPartial(std::int64_t sweep_utime, const DescribedScan& scan);
  // The sweep that is looked at has ended with these detections: tells it, and forgets the sweep.
  void FinishSweep(const std::vector<Detection>& detections);
  void PublishEarly(bool is_final, std::vector<EarlyObject> objects);
  void Publish(const DescribedScan& scan, const DetectionResult& result, const StageTimes& times);

  const Tempo tempo_;
  const Channels channels_;
  const PipelineParams params_;
  const std::string models_folder_;
  const ModelShare share_;
  std::atomic<bool> stop_{false};
  ThreadPool pool_;
  SectionJoiner<range_image_t> image_joiner_;
  SectionJoiner<feature_set_t> feature_joiner_;
  SectionJoiner<object_model_t> model_joiner_;
  PartnerJoiner partners_;
  std::int64_t num_refused_told_ = 0;  // of its refused pairs, in the last error
  SectionJoiner<range_image_t> partial_image_joiner_;
  SectionJoiner<feature_set_t> partial_feature_joiner_;
  PartnerJoiner partial_partners_;
  const std::chrono::milliseconds sweep_patience_;
  std::optional<std::chrono::steady_clock::time_point> last_partial_;  // of a sweep without a scan
  std::int64_t partial_sweep_ = 0;                                     // that sweep
  StatusReporter status_;
  SenderWatch senders_;
  PacedPublisher publisher_;
  std::optional<ShardSpeaker> shard_;
  TurnTaker turns_;
  std::int64_t num_passed_over_ = 0;  // of its scans, counted as dropped

  std::mutex new_models_mutex_;
  std::map<std::string, ObjectModel> new_models_;  // by name; not in the database yet

  // Of the worker's thread:
  std::optional<std::vector<ObjectModel>> first_models_;  // the folder's, as read at the start
  std::map<std::string, ObjectModel> bus_models_;         // by name; they replace the folder's
  std::set<std::string> bus_names_;  // of all models that came, also those of other shards
  // params_, with the number of models in all shards.
  PipelineParams shared_params_;
  std::optional<ModelDatabase> database_;
  std::optional<GrowingDetector> growing_detector_;  // of the database
  EarlyTracker tracker_;
  // The sweep that is looked at early: its last look, without objects.
  std::optional<StampedEarlyObjects> early_;

  std::atomic<std::int64_t> last_scan_;      // its utime: looks at that sweep are late
  std::atomic<std::int64_t> num_models_{0};  // that are looked for
  std::atomic<std::int64_t> num_early_looks_{0};
  std::atomic<std::int64_t> num_early_overtaken_{0};

  std::unique_ptr<NewestWorker<Job>> worker_;
  std::vector<std::unique_ptr<BytesSubscription>> subscriptions_;
};

}  // namespace rimod
