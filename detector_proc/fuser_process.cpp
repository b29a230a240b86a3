#include "detector_proc/fuser_process.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "io/detection_messages.h"
#include "io/stage_timer.h"
#include "io/status_counters.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

// The handlers only join sections and choose among candidates: milliseconds.
constexpr int kQueueCapacity = 4000;

// Shards of which "scans without" is counted by name: others' names must not fill the memory.
constexpr std::size_t kMaxNamed = 256;

SectionJoinerParams SectionsOf(const BusParams& bus) {
  SectionJoinerParams params = JoinerParamsFrom(bus);
  params.max_open = 2 * kMaxShards;
  params.max_sections = 512;  // of an answer; a hundred models make a few
  params.max_bytes = 128'000'000;
  return params;
}

// How often a turn is told: one that is lost costs so much.
constexpr auto kTurnPeriod = std::chrono::milliseconds(100);

ShardConductorParams ConductorParamsFrom(const BusParams& bus) {
  ShardConductorParams params;
  params.max_waiting = bus.max_waiting_scans;
  params.patience = std::chrono::milliseconds(static_cast<int>(1e3 * bus.shard_patience));
  return params;
}

// Of each stage the slowest shard's time; total is the slowest shard's, too.
StageTimes SlowestOf(const std::vector<ShardAnswer>& answers) {
  StageTimes slowest;
  for (const ShardAnswer& answer : answers) {
    for (const auto& [stage, ms] : answer.stage_times) {
      if (!std::isfinite(ms)) continue;
      const auto same = std::find_if(slowest.begin(), slowest.end(),
                                     [&, name = stage](const auto& t) { return t.first == name; });
      if (same == slowest.end()) {
        slowest.emplace_back(stage, ms);
      } else {
        same->second = std::max(same->second, ms);
      }
    }
  }
  return slowest;
}

}  // namespace

FuserProcess::FuserProcess(lcm::LCM* in, lcm::LCM* out, const Channels& channels,
                           const Configuration& configuration)
    : channels_(channels),
      params_(configuration.pipeline),
      params_digest_(DigestOf(configuration.pipeline)),
      sections_(SectionsOf(configuration.bus)),
      shards_(ShardJoinerParamsFrom(configuration.bus), Clock::now()),
      conductor_(ConductorParamsFrom(configuration.bus)),
      instance_(NewInstance()),
      status_(out, channels.status, "rimod-fuser"),
      senders_(in, channels.status, {channels.detections}, &status_),
      publisher_(out, configuration.bus) {
  const SubscriptionObserver observer = status_.MakeObserver();
  subscriptions_.push_back(
      SubscribeTo<shard_t>(in, channels.shards, kQueueCapacity, observer,
                           [this](const shard_t& message) { return OnShard(message); }));
  subscriptions_.push_back(SubscribeTo<shard_scan_t>(
      in, channels.shard_scans, kQueueCapacity, observer,
      [this](const shard_scan_t& message) { return OnShardScan(message); }));
  subscriptions_.push_back(SubscribeTo<shard_candidates_t>(
      in, channels.shard_candidates, kQueueCapacity, observer,
      [this](shard_candidates_t section) { return OnCandidates(std::move(section)); }));
}

std::string FuserProcess::OnShard(const shard_t& message) {
  const ShardFromMessage read = FromMessage(message);
  if (!read.shard) return read.error;
  std::string error = CheckParams(*read.shard);
  if (error.empty()) shards_.Hear(*read.shard, Clock::now());
  return error;
}

std::string FuserProcess::OnShardScan(const shard_scan_t& message) {
  const ShardScanFromMessage read = FromMessage(message);
  if (!read.scan) return read.error;
  std::string error = CheckParams(read.scan->shard);
  if (!error.empty()) return error;
  conductor_.Hear(*read.scan, Clock::now());
  Conduct();
  return "";
}

void FuserProcess::Conduct() {
  const auto now = Clock::now();
  if (!conductor_.Advance(shards_.Present(now), now) && now < next_turn_told_) return;
  next_turn_told_ = now + kTurnPeriod;
  ShardTurn turn = conductor_.turn();
  turn.fuser = instance_;
  publisher_.Publish(channels_.shard_turns, ToMessage(turn));
}

std::string FuserProcess::OnCandidates(shard_candidates_t section) {
  const auto sections = sections_.Add(std::move(section), Clock::now());
  if (!sections) return "";
  JoinedShardAnswer joined = JoinShardSections(*sections);
  if (!joined.answer) return joined.error;
  std::string error = CheckParams(joined.answer->shard);
  if (!error.empty()) return error;
  const std::int64_t num_twins = shards_.counters().twins;
  const std::string name = joined.answer->shard.name;
  conductor_.Answered(joined.answer->shard, joined.answer->utime, joined.answer->scan);
  shards_.Add(std::move(*joined.answer), Clock::now());
  if (shards_.counters().twins > num_twins)
    status_.ReportError("twin " + name, "shard " + name + " runs twice: only one is heard");
  Conduct();  // the shards' time is dearer than ours
  FuseDecided();
  return "";
}

std::string FuserProcess::CheckParams(const Shard& shard) const {
  if (shard.params == params_digest_) return "";
  return "shard " + shard.name + " works with other parameters than ours, or is of another version";
}

void FuserProcess::FuseDecided() {
  for (AnsweredScan& scan : shards_.TakeDecided(Clock::now())) Fuse(std::move(scan));
}

void FuserProcess::Fuse(AnsweredScan scan) {
  const auto begin = Clock::now();
  ReportOverlap(scan);
  StampedDetections detections;
  detections.utime = scan.answers.front().utime;
  detections.stage_times = SlowestOf(scan.answers);
  std::vector<JudgedScan> parts;
  for (ShardAnswer& answer : scan.answers) parts.push_back(std::move(answer.judged));
  const JudgedScan judged = Joined(parts);
  const DetectionResult result = ChooseDetections(judged, params_);
  const std::chrono::duration<double, std::milli> fusing = Clock::now() - begin;
  detections.stage_times.emplace_back("fusing", fusing.count());
  detections.T_local_sensor = judged.T_local_sensor;
  detections.num_models = static_cast<int>(judged.models.size());
  detections.detections = result.detections;
  publisher_.Publish(channels_.hypotheses,
                     ToMessage(result.hypotheses, result.num_hypotheses_found, detections.utime));
  publisher_.Publish(channels_.detections, ToMessage(detections));
  status_.AddStageTimes(detections.stage_times);
  status_.CountOut();
  spdlog::info("scan {}: {} detections from {} shards, {} models", detections.utime,
               result.detections.size(), scan.answers.size(), judged.models.size());
  if (!scan.without.empty()) ++num_partial_;
  for (const std::string& shard : scan.without)
    if (num_without_.count(shard) != 0 || num_without_.size() < kMaxNamed) ++num_without_[shard];
}

void FuserProcess::ReportOverlap(const AnsweredScan& scan) {
  std::map<std::string, std::string> shard_of;  // by model
  for (const ShardAnswer& answer : scan.answers) {
    for (const CandidateModel& model : answer.judged.models) {
      const auto [first, is_new] = shard_of.emplace(model.name, answer.shard.name);
      if (is_new) continue;
      status_.ReportError("overlap of " + first->second + " and " + answer.shard.name,
                          "model " + model.name + " is with shard " + first->second +
                              " and shard " + answer.shard.name + ": the latter's is left out");
    }
  }
}

void FuserProcess::OnIdle() {
  sections_.GiveUpStale(Clock::now());
  Conduct();
  FuseDecided();
  ReportShards();
  status_.SetSectionCounters("candidates", sections_.counters());
  status_.SetCounter("turns", conductor_.turn().number);
  status_.SetCounter("turns given up", conductor_.num_given_up());
  status_.SetCounter("unsent messages", publisher_.num_failed());
  status_.SetGauge(kWaitingScansCounter, static_cast<std::int64_t>(shards_.num_open()));
  status_.SetGauge(kWaitingMessagesCounter, publisher_.num_waiting());
  senders_.Report(Clock::now());
  status_.PublishIfDue();
}

void FuserProcess::ReportShards() {
  const ShardCounters& counters = shards_.counters();
  status_.SetCounter("answers late", counters.late);
  status_.SetCounter("answers repeated", counters.repeated);
  status_.SetCounter("answers of twins", counters.twins);
  status_.SetCounter("shards too many", counters.too_many);
  status_.SetCounter("scans lacking a shard", num_partial_);
  for (const auto& [shard, number] : num_without_)
    status_.SetCounter("scans without shard " + shard, number);
  status_.SetGauge("shards", static_cast<std::int64_t>(shards_.Present(Clock::now()).size()));
  const std::vector<std::string> missing = shards_.Missing(Clock::now());
  status_.SetGauge("shards missing", static_cast<std::int64_t>(missing.size()));
  for (const std::string& name : missing) {
    if (std::find(missing_.begin(), missing_.end(), name) != missing_.end()) continue;
    status_.ReportError("missing " + name,
                        "shard " + name + " is missing: its models are not looked for");
  }
  missing_ = missing;
}

}  // namespace rimod
