#include "detector_proc/matcher_process.h"

#include <malloc.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "io/detection_messages.h"
#include "io/feature_messages.h"
#include "io/model_file.h"
#include "io/model_messages.h"
#include "io/range_image_messages.h"
#include "io/stage_timer.h"
#include "io/stoppable.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

// The handlers only join sections, so that few wait; some whole scans may.
constexpr int kQueueCapacity = 1000;

// Models that a process keeps: others' names must not fill its memory.
constexpr std::size_t kMaxModels = 256;

std::chrono::milliseconds PatienceOf(const BusParams& params) {
  return std::chrono::milliseconds(static_cast<int>(1e3 * params.join_patience));
}

}  // namespace

MatcherProcess::MatcherProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                               const Configuration& configuration, int num_threads,
                               std::string models_folder, std::vector<ObjectModel> models)
    : channels_(channels),
      params_(configuration.pipeline),
      models_folder_(std::move(models_folder)),
      pool_(num_threads),
      image_joiner_(JoinerParamsFrom(configuration.bus)),
      feature_joiner_(JoinerParamsFrom(configuration.bus)),
      model_joiner_(JoinerParamsFrom(configuration.bus)),
      partners_(PatienceOf(configuration.bus)),
      status_(out, channels.status, "rimod-matcher"),
      publisher_(out, configuration.bus),
      first_models_(std::move(models)) {
  worker_ = std::make_unique<NewestWorker<DescribedScan>>(
      configuration.bus.max_waiting_scans, [this] { RebuildDatabase(); },
      [this](const DescribedScan& scan) { Work(scan); });
  worker_->Poke();
  const SubscriptionObserver observer = status_.MakeObserver();
  subscriptions_.push_back(SubscribeTo<range_image_t>(
      in, channels.range_image, kQueueCapacity, observer,
      [this](range_image_t section) { return OnRangeImage(std::move(section)); }));
  subscriptions_.push_back(SubscribeTo<feature_set_t>(
      in, channels.features, kQueueCapacity, observer,
      [this](feature_set_t section) { return OnFeatures(std::move(section)); }));
  subscriptions_.push_back(SubscribeTo<object_model_t>(
      in, channels.model, kQueueCapacity, observer,
      [this](object_model_t section) { return OnModel(std::move(section)); }));
}

MatcherProcess::~MatcherProcess() {
  stop_ = true;
  worker_.reset();
}

std::string MatcherProcess::OnRangeImage(range_image_t section) {
  const auto sections = image_joiner_.Add(std::move(section), Clock::now());
  if (!sections) return "";
  JoinedRangeImage joined = JoinRangeImageSections(*sections);
  if (!joined.image) return joined.error;
  Give(partners_.AddImage(sections->front().utime, std::move(*joined.image), Clock::now()));
  return "";
}

std::string MatcherProcess::OnFeatures(feature_set_t section) {
  const auto sections = feature_joiner_.Add(std::move(section), Clock::now());
  if (!sections) return "";
  JoinedFeatures joined = JoinFeatureSections(*sections);
  if (!joined.features) return joined.error;
  Give(partners_.AddFeatures(sections->front().utime, std::move(*joined.features), Clock::now()));
  return "";
}

std::string MatcherProcess::OnModel(object_model_t section) {
  const auto sections = model_joiner_.Add(std::move(section), Clock::now());
  if (!sections) return "";
  JoinedModel joined = JoinModelSections(*sections);
  if (!joined.model) return joined.error;
  spdlog::info("model {} arrived", joined.model->name);
  {
    const std::lock_guard<std::mutex> lock(new_models_mutex_);
    if (new_models_.size() >= kMaxModels) return "too many models";
    const std::string name = joined.model->name;
    new_models_.insert_or_assign(name, std::move(*joined.model));
  }
  worker_->Poke();
  return "";
}

void MatcherProcess::Give(std::optional<DescribedScan> scan) {
  if (scan) status_.CountDropped("scans overtaken", worker_->Give(std::move(*scan)));
}

// The models of the folder: those that were read at the start, then as they are there now.
std::vector<ObjectModel> MatcherProcess::ModelsOfFolder(const Execution& execution) {
  if (first_models_) {
    std::vector<ObjectModel> models = std::move(*first_models_);
    first_models_.reset();
    return models;
  }
  if (models_folder_.empty()) return {};
  ModelFolder folder = LoadModelFolder(models_folder_, execution);
  if (!folder.error.empty()) folder.bad_files.push_back(folder.error);
  for (const std::string& error : folder.bad_files) status_.ReportError(error, error);
  return std::move(folder.models);
}

void MatcherProcess::RebuildDatabase() try {
  std::map<std::string, ObjectModel> bus_models;
  {
    const std::lock_guard<std::mutex> lock(new_models_mutex_);
    if (new_models_.empty() && database_) return;
    bus_models.swap(new_models_);
  }
  bus_models.merge(std::map<std::string, ObjectModel>(bus_models_));  // keeps the new of one name
  const Execution execution = StoppableExecution(pool_.MakeExecution(), &stop_);
  const auto begin = Clock::now();
  std::vector<ObjectModel> models = ModelsOfFolder(execution);
  models.erase(
      std::remove_if(models.begin(), models.end(),
                     [&](const ObjectModel& model) { return bus_models.count(model.name); }),
      models.end());
  if (models.size() + bus_models.size() > kMaxModels) {
    status_.CountDropped("models failed");
    return status_.ReportError("models", "more models than can be kept: the new ones are left out");
  }
  for (const auto& [name, model] : bus_models) models.push_back(model);
  database_.emplace(std::move(models), params_, execution);
  bus_models_ = std::move(bus_models);
  malloc_trim(0);  // what was read and is not needed any more goes back to the system
  const std::chrono::duration<double, std::milli> elapsed = Clock::now() - begin;
  spdlog::info("looking for {} models; index built in {:.0f} ms", database_->models().size(),
               elapsed.count());
} catch (const Stopped&) {
  // The process ends.
} catch (const std::exception& error) {
  status_.CountDropped("models failed");
  status_.ReportError(error.what(), std::string("models: ") + error.what());
}

void MatcherProcess::Work(const DescribedScan& scan) try {
  if (!database_) return;
  const auto begin = Clock::now();
  StageTimer timer;
  Execution execution = pool_.MakeExecution();
  timer.Watch(&execution);
  execution = StoppableExecution(std::move(execution), &stop_);
  const DetectionResult result =
      DetectObjects(scan.image, scan.features, *database_, params_, execution);
  const std::chrono::duration<double, std::milli> total = Clock::now() - begin;
  timer.Add("total", total.count());
  Publish(scan, result, timer.times());
  spdlog::info("scan {}: {} detections, {} hypotheses, {:.0f} ms", scan.utime,
               result.detections.size(), result.num_hypotheses_found, total.count());
} catch (const Stopped&) {
  // The process ends: the scan is left undone.
} catch (const std::exception& error) {
  status_.CountDropped("scans failed");
  status_.ReportError(error.what(), "scan " + std::to_string(scan.utime) + ": " + error.what());
}

void MatcherProcess::Publish(const DescribedScan& scan, const DetectionResult& result,
                             const StageTimes& times) {
  publisher_.Publish(channels_.hypotheses,
                     ToMessage(result.hypotheses, result.num_hypotheses_found, scan.utime));
  StampedDetections detections;
  detections.utime = scan.utime;
  detections.T_local_sensor = scan.image.T_local_sensor();
  detections.num_models = static_cast<int>(database_->models().size());
  detections.detections = result.detections;
  detections.stage_times = times;
  publisher_.Publish(channels_.detections, ToMessage(detections));
  status_.AddStageTimes(times);
  status_.CountOut();
}

void MatcherProcess::OnIdle() {
  const auto now = Clock::now();
  image_joiner_.GiveUpStale(now);
  feature_joiner_.GiveUpStale(now);
  model_joiner_.GiveUpStale(now);
  partners_.GiveUpStale(now);
  status_.SetSectionCounters("range image", image_joiner_.counters());
  status_.SetSectionCounters("features", feature_joiner_.counters());
  status_.SetSectionCounters("model", model_joiner_.counters());
  status_.SetCounter("scans without partner", partners_.num_unpaired(), true);
  status_.SetCounter("unsent messages", publisher_.num_failed());
  status_.PublishIfDue();
}

}  // namespace rimod
