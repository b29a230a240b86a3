#pragma once

#include <atomic>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include "io/thread_pool.h"
#include "rimod/features.h"
#include "rimod/model_database.h"
#include "rimod/range_image.h"
#include "tuning/labelled_scans.h"
#include "tuning/model_sources.h"
#include "tuning/trial_store.h"
#include "tuning/varied_parameters.h"

namespace rimod {

// Detects in labelled scans with one setting after the other, a scan on each thread, and counts
// what is right. Range images, features and models are kept for settings that share them.
class DetectorTrials {
 public:
  // The pool and stop must outlive it. Classes of the labels need models.
  DetectorTrials(std::vector<Dimension> dimensions, const Configuration& base, ModelSources models,
                 std::vector<LabelledInput> scans, ThreadPool* pool, const std::atomic<bool>* stop);

  // A TrialRunner; ms is the processor time of a scan from points to detections. Throws Stopped
  // soon after stop was set.
  std::optional<std::vector<ScanCounts>> Run(const Setting& setting, const std::vector<int>& scans);

 private:
  // A scan as the matcher takes it.
  struct DescribedScan {
    RangeImage image;
    FeatureSet features;
    double ms = 0.0;  // for both
  };
  // All scans with one way of describing them, as far as they were needed.
  struct Description {
    std::string key;
    std::vector<std::optional<DescribedScan>> scans;
  };
  // Models with their views.
  struct BuiltModels {
    std::string surface_key;
    std::vector<ObjectModel> models;
  };

  Description* DescriptionFor(const Setting& setting);
  const std::vector<ObjectModel>& ModelsFor(const Setting& setting, const PipelineParams& params);
  DescribedScan Describe(int scan, const PipelineParams& params) const;
  ScanCounts DetectIn(int scan, const DescribedScan& described, const ModelDatabase& database,
                      const PipelineParams& params) const;
  std::string KeyOf(const Setting& setting, const std::vector<std::string>& sections) const;

  std::vector<Dimension> dimensions_;
  Configuration base_;
  ModelSources sources_;
  std::vector<LabelledInput> scans_;
  ThreadPool* pool_;
  const std::atomic<bool>* stop_;
  std::list<Description> descriptions_;  // the one used last in front
  std::list<BuiltModels> models_;        // likewise
};

}  // namespace rimod
