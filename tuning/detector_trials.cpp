#include "tuning/detector_trials.h"

#include <time.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "io/stoppable.h"
#include "rimod/detector.h"

namespace rimod {
namespace {

// Kept for settings to come: about two megabytes a scan, some more a set of models.
constexpr std::size_t kDescribedScans = 300;
constexpr std::size_t kMaxDescriptions = 6;
constexpr std::size_t kMaxModels = 6;

// Of the calling thread: other work on the machine does not count.
double ProcessorMs() {
  timespec now = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

template <typename Entry>
void MoveToFront(std::list<Entry>* list, typename std::list<Entry>::iterator entry) {
  list->splice(list->begin(), *list, entry);
}

}  // namespace

DetectorTrials::DetectorTrials(std::vector<Dimension> dimensions, const Configuration& base,
                               ModelSources models, std::vector<LabelledInput> scans,
                               ThreadPool* pool, const std::atomic<bool>* stop)
    : dimensions_(std::move(dimensions)),
      base_(base),
      sources_(std::move(models)),
      scans_(std::move(scans)),
      pool_(pool),
      stop_(stop) {}

std::string DetectorTrials::KeyOf(const Setting& setting,
                                  const std::vector<std::string>& sections) const {
  std::string key;
  for (std::size_t i = 0; i < dimensions_.size(); ++i) {
    const std::string& name = dimensions_[i].name;
    const std::string section = name.substr(0, name.find('.'));
    if (std::find(sections.begin(), sections.end(), section) != sections.end())
      key += setting[i] + ";";
  }
  return key;
}

DetectorTrials::Description* DetectorTrials::DescriptionFor(const Setting& setting) {
  const std::string key =
      KeyOf(setting, {"range_image", "interest_points", "range_patch", "spherical_spin"});
  const auto known = std::find_if(descriptions_.begin(), descriptions_.end(),
                                  [&](const Description& entry) { return entry.key == key; });
  if (known != descriptions_.end()) {
    MoveToFront(&descriptions_, known);
    return &descriptions_.front();
  }
  const std::size_t room = kDescribedScans / std::max<std::size_t>(1, scans_.size());
  const std::size_t most = std::clamp<std::size_t>(room, 1, kMaxDescriptions);
  if (descriptions_.size() >= most) descriptions_.pop_back();
  descriptions_.emplace_front();
  descriptions_.front().key = key;
  descriptions_.front().scans.resize(scans_.size());
  return &descriptions_.front();
}

const std::vector<ObjectModel>& DetectorTrials::ModelsFor(const Setting& setting,
                                                          const PipelineParams& params) {
  const Execution execution = StoppableExecution(pool_->MakeExecution(), stop_);
  const std::string surface_key = KeyOf(setting, {"model_surface"});
  const BuiltModels* same_surface = nullptr;
  for (auto entry = models_.begin(); entry != models_.end(); ++entry) {
    if (entry->surface_key != surface_key) continue;
    if (std::all_of(entry->models.begin(), entry->models.end(),
                    [&](const ObjectModel& m) { return ModelMatchesParams(m, params); })) {
      MoveToFront(&models_, entry);
      return models_.front().models;
    }
    same_surface = &*entry;
  }
  BuiltModels built{surface_key, {}};
  if (same_surface != nullptr) {
    built.models = same_surface->models;
    for (ObjectModel& model : built.models) ComputeModelViews(params, execution, &model);
  } else {
    built.models = BuildModels(sources_, params, execution);
  }
  if (models_.size() >= kMaxModels) models_.pop_back();
  models_.push_front(std::move(built));
  return models_.front().models;
}

DetectorTrials::DescribedScan DetectorTrials::Describe(int scan,
                                                       const PipelineParams& params) const {
  const Execution execution = StoppableExecution(Execution{}, stop_);
  const double begin = ProcessorMs();
  DescribedScan described;
  described.image = ComputeRangeImage(scans_[scan].scan, params, execution);
  described.features = ExtractFeatures(described.image, params, execution);
  described.ms = ProcessorMs() - begin;
  return described;
}

ScanCounts DetectorTrials::DetectIn(int scan, const DescribedScan& described,
                                    const ModelDatabase& database,
                                    const PipelineParams& params) const {
  const double begin = ProcessorMs();
  const DetectionResult result = DetectObjects(described.image, described.features, database,
                                               params, StoppableExecution(Execution{}, stop_));
  ScanCounts counts;
  counts.scans = 1;
  counts.ms = described.ms + ProcessorMs() - begin;
  const HitCount hits =
      CountHits({{scans_[scan].objects, result.detections}}, sources_.shapes, HitParams());
  counts.right = hits.total.right;
  counts.posed = hits.num_posed;
  counts.false_alarms = hits.total.false_alarms;
  counts.missed = hits.total.missed;
  return counts;
}

std::optional<std::vector<ScanCounts>> DetectorTrials::Run(const Setting& setting,
                                                           const std::vector<int>& scans) {
  const AppliedSetting applied = ApplySetting(dimensions_, setting, base_);
  if (!applied.configuration) return std::nullopt;
  const PipelineParams& params = applied.configuration->pipeline;
  std::vector<ScanCounts> counts(scans.size());
  try {
    const ModelDatabase database(ModelsFor(setting, params), params,
                                 StoppableExecution(pool_->MakeExecution(), stop_));
    Description* const description = DescriptionFor(setting);
    pool_->ParallelFor(scans.size(), [&](std::size_t i) {
      std::optional<DescribedScan>& described = description->scans[scans[i]];
      if (!described) described = Describe(scans[i], params);
      counts[i] = DetectIn(scans[i], *described, database, params);
    });
  } catch (const std::invalid_argument&) {  // a combination that no model or scan goes with
    return std::nullopt;
  }
  return counts;
}

}  // namespace rimod
