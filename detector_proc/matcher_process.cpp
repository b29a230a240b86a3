#include "detector_proc/matcher_process.h"

#include <malloc.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>
#include <utility>

#include "io/detection_messages.h"
#include "io/feature_messages.h"
#include "io/model_file.h"
#include "io/model_messages.h"
#include "io/range_image_messages.h"
#include "io/stage_timer.h"
#include "io/status_counters.h"
#include "io/stoppable.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

// The handlers only join sections, so that few wait; some whole scans may.
constexpr int kQueueCapacity = 1000;

// Models that a process keeps: others' names must not fill its memory.
constexpr std::size_t kMaxModels = 256;

constexpr std::int64_t kNoScan = std::numeric_limits<std::int64_t>::min();

std::vector<std::string> NamesOf(const std::vector<ObjectModel>& models) {
  std::vector<std::string> names;
  for (const ObjectModel& model : models) names.push_back(model.name);
  return names;
}

std::chrono::milliseconds PatienceOf(const BusParams& params) {
  return std::chrono::milliseconds(static_cast<int>(1e3 * params.join_patience));
}

}  // namespace

MatcherProcess::MatcherProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                               const Configuration& configuration, int num_threads,
                               std::string models_folder, std::vector<ObjectModel> models,
                               const ModelShare& share, const Tempo& tempo)
    : tempo_(tempo),
      channels_(channels),
      params_(configuration.pipeline),
      models_folder_(std::move(models_folder)),
      share_(share),
      pool_(num_threads),
      image_joiner_(JoinerParamsFrom(configuration.bus)),
      feature_joiner_(JoinerParamsFrom(configuration.bus)),
      model_joiner_(JoinerParamsFrom(configuration.bus)),
      partners_(PatienceOf(configuration.bus)),
      partial_image_joiner_(JoinerParamsFrom(configuration.bus)),
      partial_feature_joiner_(JoinerParamsFrom(configuration.bus)),
      partial_partners_(PatienceOf(configuration.bus)),
      sweep_patience_(PatienceOf(configuration.bus) +
                      std::chrono::milliseconds(static_cast<int>(1e3 * params_.early.period))),
      status_(out, channels.status, "rimod-matcher", tempo),
      // Shards that are too many are noticed by the fuser.
      senders_(in, channels.status,
               share.is_all() ? std::vector<std::string>{channels.detections}
                              : std::vector<std::string>{},
               &status_),
      publisher_(out, configuration.bus, tempo),
      turns_(configuration.bus.max_waiting_scans),
      first_models_(std::move(models)),
      tracker_(params_.early),
      last_scan_(kNoScan) {
  if (!share.is_all()) shard_.emplace(share, params_, channels, &publisher_);
  worker_ = std::make_unique<NewestWorker<Job>>(
      configuration.bus.max_waiting_scans, [this] { RebuildDatabase(); },
      [this](const Job& job) { Work(job); }, tempo.at_once());
  worker_->Poke();
  const SubscriptionObserver observer = status_.MakeObserver();
  subscriptions_.push_back(SubscribeTo<range_image_t>(
      in, channels.range_image, kQueueCapacity, observer,
      [this](range_image_t section) { return OnRangeImage(std::move(section)); }));
  subscriptions_.push_back(SubscribeTo<feature_set_t>(
      in, channels.features, kQueueCapacity, observer,
      [this](feature_set_t section) { return OnFeatures(std::move(section)); }));
  if (!shard_) SubscribeToPartials(in, observer);
  if (shard_) {
    subscriptions_.push_back(
        SubscribeTo<shard_turn_t>(in, channels.shard_turns, kQueueCapacity, observer,
                                  [this](const shard_turn_t& message) { return OnTurn(message); }));
  }
  subscriptions_.push_back(SubscribeTo<object_model_t>(
      in, channels.model, kQueueCapacity, observer,
      [this](object_model_t section) { return OnModel(std::move(section)); }));
}

void MatcherProcess::SubscribeToPartials(lcm::LCM* in, const SubscriptionObserver& observer) {
  subscriptions_.push_back(SubscribeTo<partial_range_image_t>(
      in, channels_.partial_range_image, kQueueCapacity, observer,
      [this](partial_range_image_t section) { return OnPartialRangeImage(std::move(section)); }));
  subscriptions_.push_back(SubscribeTo<partial_feature_set_t>(
      in, channels_.partial_features, kQueueCapacity, observer,
      [this](partial_feature_set_t section) { return OnPartialFeatures(std::move(section)); }));
}

MatcherProcess::~MatcherProcess() {
  stop_ = true;
  worker_.reset();
}

std::string MatcherProcess::OnRangeImage(range_image_t section) {
  const auto sections = image_joiner_.Add(std::move(section), tempo_.Now());
  if (!sections) return "";
  JoinedRangeImage joined = JoinRangeImageSections(*sections);
  if (!joined.image) return joined.error;
  Give(partners_.AddImage(sections->front().utime, std::move(*joined.image), tempo_.Now()));
  return "";
}

std::string MatcherProcess::OnFeatures(feature_set_t section) {
  const auto sections = feature_joiner_.Add(std::move(section), tempo_.Now());
  if (!sections) return "";
  JoinedFeatures joined = JoinFeatureSections(*sections);
  if (!joined.features) return joined.error;
  Give(partners_.AddFeatures(sections->front().utime, std::move(*joined.features), tempo_.Now()));
  return "";
}

std::string MatcherProcess::OnModel(object_model_t section) {
  const auto sections = model_joiner_.Add(std::move(section), tempo_.Now());
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

std::string MatcherProcess::OnPartialRangeImage(partial_range_image_t section) {
  const auto sections = partial_image_joiner_.Add(std::move(section.section), tempo_.Now());
  if (!sections) return "";
  JoinedRangeImage joined = JoinRangeImageSections(*sections);
  if (!joined.image) return joined.error;
  GivePartial(section.utime, partial_partners_.AddImage(sections->front().utime,
                                                        std::move(*joined.image), tempo_.Now()));
  return "";
}

std::string MatcherProcess::OnPartialFeatures(partial_feature_set_t section) {
  const auto sections = partial_feature_joiner_.Add(std::move(section.section), tempo_.Now());
  if (!sections) return "";
  JoinedFeatures joined = JoinFeatureSections(*sections);
  if (!joined.features) return joined.error;
  GivePartial(section.utime,
              partial_partners_.AddFeatures(sections->front().utime, std::move(*joined.features),
                                            tempo_.Now()));
  return "";
}

void MatcherProcess::Give(std::optional<DescribedScan> scan) {
  if (!scan) return;
  last_scan_ = scan->utime;
  if (scan->utime == partial_sweep_) last_partial_.reset();
  // The fuser knows of a shard from when it is ready.
  if (shard_ && shard_->is_ready() && !tempo_.at_once()) return GiveForTurn(std::move(*scan));
  GiveToWorker(std::move(scan));
}

void MatcherProcess::GiveToWorker(std::optional<DescribedScan> scan) {
  if (!scan) return;
  status_.CountDropped("scans overtaken",
                       worker_->Give({JobKind::kScan, scan->utime, std::move(*scan)}));
}

void MatcherProcess::GiveForTurn(DescribedScan scan) {
  const std::int64_t utime = scan.utime;
  const std::int64_t digest = DigestOf(scan);
  GiveToWorker(turns_.Add(std::move(scan), digest, tempo_.Now()));
  shard_->TellScan(utime, digest, /*held=*/true);
}

std::string MatcherProcess::OnTurn(const shard_turn_t& message) {
  const ShardTurnFromMessage turn = FromMessage(message);
  if (!turn.turn) return turn.error;
  GiveToWorker(turns_.Hear(*turn.turn, tempo_.Now()));
  if (turns_.TakeLacking() && shard_->is_ready())
    shard_->TellScan(turn.turn->utime, turn.turn->scan, /*held=*/false);
  return "";
}

void MatcherProcess::GivePartial(std::int64_t sweep_utime, std::optional<DescribedScan> scan) {
  if (!scan || last_scan_ == sweep_utime) return;
  partial_sweep_ = sweep_utime;
  last_partial_ = tempo_.Now();
  num_early_overtaken_ += worker_->GiveWhenIdle({JobKind::kPartial, sweep_utime, std::move(*scan)});
}

// A sweep that ended incomplete, or whose scan got lost, has no detections.
void MatcherProcess::GiveUpSilentSweep() {
  if (!last_partial_ || tempo_.Now() - *last_partial_ <= sweep_patience_) return;
  last_partial_.reset();
  worker_->GiveWhenIdle({JobKind::kGiveUp, partial_sweep_, {}});
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
  const ModelSplit split(share_, NamesOf(models));
  CountModelsOfAllShards(models, bus_models);
  models.erase(std::remove_if(models.begin(), models.end(),
                              [&](const ObjectModel& model) {
                                return bus_models.count(model.name) || !split.Takes(model.name);
                              }),
               models.end());
  for (auto it = bus_models.begin(); it != bus_models.end();)
    it = split.Takes(it->first) ? std::next(it) : bus_models.erase(it);
  if (models.size() + bus_models.size() > kMaxModels) {
    status_.CountDropped("models failed");
    return status_.ReportError("models", "more models than can be kept: the new ones are left out");
  }
  for (const auto& [name, model] : bus_models) models.push_back(model);
  growing_detector_.reset();
  database_.emplace(std::move(models), params_, execution);
  growing_detector_.emplace(*database_, params_);
  bus_models_ = std::move(bus_models);
  num_models_ = static_cast<std::int64_t>(database_->models().size());
  if (shard_) shard_->SetNumModels(static_cast<int>(num_models_));
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

// Each model gets the part of the work that it would have beside all the others in one matcher.
void MatcherProcess::CountModelsOfAllShards(const std::vector<ObjectModel>& of_folder,
                                            const std::map<std::string, ObjectModel>& of_bus) {
  shared_params_ = params_;
  if (!shard_ || params_.ranking.num_models > 0) return;
  for (const auto& [name, model] : of_bus)
    if (bus_names_.size() < kMaxModels) bus_names_.insert(name);
  std::set<std::string> names = bus_names_;
  for (const ObjectModel& model : of_folder) names.insert(model.name);
  shared_params_.ranking.num_models = static_cast<int>(names.size());
}

void MatcherProcess::Work(const Job& job) try {
  if (!database_) return;
  if (job.kind == JobKind::kScan && shard_) {
    WorkAsShard(job.scan);
  } else if (job.kind == JobKind::kScan) {
    WorkOnScan(job.scan);
  } else if (job.kind == JobKind::kPartial) {
    WorkOnPartial(job.sweep_utime, job.scan);
  } else if (early_ && early_->utime == job.sweep_utime) {
    FinishSweep({});
    growing_detector_->Forget();
  }
} catch (const Stopped&) {
  // The process ends, or a whole scan came in: this one is left undone.
  if (job.kind == JobKind::kPartial) ++num_early_overtaken_;
} catch (const std::exception& error) {
  status_.CountDropped("scans failed");
  status_.ReportError(error.what(), "scan " + std::to_string(job.scan.utime) + ": " + error.what());
}

void MatcherProcess::WorkOnScan(const DescribedScan& scan) {
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
  if (!early_ || early_->utime != scan.utime) return;
  early_->T_local_sensor = scan.image.T_local_sensor();
  FinishSweep(result.detections);
  growing_detector_->Forget();
}

void MatcherProcess::WorkAsShard(const DescribedScan& scan) {
  const auto begin = Clock::now();
  StageTimer timer;
  Execution execution = pool_.MakeExecution();
  timer.Watch(&execution);
  execution = StoppableExecution(std::move(execution), &stop_);
  ShardAnswer answer;
  answer.utime = scan.utime;
  answer.scan = DigestOf(scan);
  answer.judged = WorthJoining(
      JudgeObjects(scan.image, scan.features, *database_, shared_params_, execution), params_);
  const std::chrono::duration<double, std::milli> total = Clock::now() - begin;
  timer.Add("total", total.count());
  answer.stage_times = timer.times();
  status_.AddStageTimes(answer.stage_times);
  status_.CountOut();
  spdlog::info("scan {}: {} candidates, {:.0f} ms", scan.utime, answer.judged.candidates.size(),
               total.count());
  shard_->Answer(std::move(answer));
}

void MatcherProcess::WorkOnPartial(std::int64_t sweep_utime, const DescribedScan& scan) {
  if (last_scan_ == sweep_utime) throw Stopped();
  const auto begin = Clock::now();
  const Execution execution =
      StoppableExecution(StoppableExecution(pool_.MakeExecution(), &stop_), &worker_->wanted());
  const DetectionResult result =
      growing_detector_->Look(Time(sweep_utime), scan.image, scan.features, execution);
  const std::vector<EarlySighting> sightings =
      SightingsOf(result.detections, scan.image, *database_);
  if (early_ && early_->utime != sweep_utime) FinishSweep({});
  early_.emplace();
  early_->utime = sweep_utime;
  early_->known_until = scan.utime;
  early_->T_local_sensor = scan.image.T_local_sensor();
  early_->num_models = static_cast<int>(database_->models().size());
  PublishEarly(/*is_final=*/false, tracker_.Update(Time(sweep_utime), Time(scan.utime), sightings));
  ++num_early_looks_;
  const std::chrono::duration<double, std::milli> total = Clock::now() - begin;
  const StageTimes times = {{"partial_total", total.count()}};
  status_.AddStageTimes(times);
  tempo_.TellStageTimes(sweep_utime, times);
}

void MatcherProcess::FinishSweep(const std::vector<Detection>& detections) {
  PublishEarly(/*is_final=*/true,
               tracker_.Finish(Time(early_->utime), Time(early_->known_until), detections));
  early_.reset();
}

void MatcherProcess::PublishEarly(bool is_final, std::vector<EarlyObject> objects) {
  StampedEarlyObjects early = *early_;
  early.is_final = is_final;
  early.objects = std::move(objects);
  publisher_.Publish(channels_.early_detections, ToMessage(early));
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
  tempo_.TellStageTimes(scan.utime, times);
  status_.CountOut();
}

void MatcherProcess::OnIdle() {
  const auto now = tempo_.Now();
  image_joiner_.GiveUpStale(now);
  feature_joiner_.GiveUpStale(now);
  model_joiner_.GiveUpStale(now);
  partners_.GiveUpStale(now);
  partial_image_joiner_.GiveUpStale(now);
  partial_feature_joiner_.GiveUpStale(now);
  partial_partners_.GiveUpStale(now);
  GiveUpSilentSweep();
  if (shard_) ReportTurns();
  status_.SetSectionCounters("range image", image_joiner_.counters());
  status_.SetSectionCounters("features", feature_joiner_.counters());
  status_.SetSectionCounters("model", model_joiner_.counters());
  ReportPartners();
  status_.SetCounter("early looks", num_early_looks_);
  status_.SetCounter("early looks overtaken", num_early_overtaken_);
  status_.SetCounter("unsent messages", publisher_.num_failed());
  status_.SetGauge("models", num_models_);
  status_.SetGauge(kWaitingScansCounter,
                   static_cast<std::int64_t>(worker_->num_waiting() + turns_.num_held()));
  status_.SetGauge(kWaitingMessagesCounter, publisher_.num_waiting());
  senders_.Report(tempo_.Now());
  status_.PublishIfDue();
}

void MatcherProcess::ReportTurns() {
  const auto now = tempo_.Now();
  shard_->AnnounceIfDue(now);
  GiveToWorker(turns_.OnIdle(now));
  status_.CountDropped("scans overtaken", turns_.num_overtaken() - num_passed_over_);
  num_passed_over_ = turns_.num_overtaken();
}

void MatcherProcess::ReportPartners() {
  status_.SetCounter("scans without partner", partners_.num_unpaired(), true);
  status_.SetCounter("pairs of two scans refused", partners_.num_refused());
  if (partners_.num_refused() == num_refused_told_) return;
  num_refused_told_ = partners_.num_refused();
  status_.ReportError("pairs refused",
                      "scan " + std::to_string(partners_.refused_utime()) +
                          ": range image and features of two scans with one utime are not mixed");
}

}  // namespace rimod
