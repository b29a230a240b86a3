#include "io/status_reporter.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <lcm/lcm-cpp.hpp>
#include <vector>

#include "io/message_codec.h"
#include "io/process_usage.h"
#include "io/status_counters.h"
#include "io/version.h"

namespace rimod {
namespace {

constexpr auto kPeriod = std::chrono::seconds(1);
constexpr std::size_t kMedianScans = 20;
// Causes come partly from outside: without bounds a hostile neighbour could fill the memory.
constexpr std::size_t kMaxNames = 200;
constexpr std::size_t kMaxNameLength = 160;

std::string HostName() {
  std::array<char, 256> name = {};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

double Median(const std::deque<double>& values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() / 2];
}

std::int64_t WallClockUtime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

// Lists hold text that ends at a zero byte and is not endless.
std::string Trimmed(const std::string& text) {
  std::string trimmed = text.substr(0, kMaxNameLength);
  std::replace(trimmed.begin(), trimmed.end(), '\0', ' ');
  return trimmed;
}

void AddCounter(const std::string& name, std::int64_t value, status_t* status) {
  counter_t counter;
  counter.name = name;
  counter.value = value;
  status->counters.push_back(std::move(counter));
}

}  // namespace

StatusReporter::StatusReporter(lcm::LCM* lcm, std::string channel, std::string process, Tempo tempo)
    : lcm_(lcm),
      channel_(std::move(channel)),
      tempo_(std::move(tempo)),
      totals_{},
      next_publish_(tempo_.Now()) {
  totals_.process = std::move(process);
  totals_.version = Version();
  totals_.pid = static_cast<std::int32_t>(getpid());
  totals_.host = HostName();
}

void StatusReporter::CountIn() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++totals_.num_in;
}

void StatusReporter::CountOut() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++totals_.num_out;
}

void StatusReporter::CountDropped(const std::string& cause, std::int64_t number) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (number == 0) return;
  totals_.num_dropped += number;
  Counter(kDroppedPrefix + cause) += number;
}

void StatusReporter::CountRejected(const std::string& channel, const std::string& cause) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++totals_.num_rejected;
  const std::string kind = channel + ": " + cause;
  ++Counter(kRejectedPrefix + kind);
  LogOnce(kind, "message on " + channel + " rejected: " + cause);
}

void StatusReporter::SetCounter(const std::string& name, std::int64_t value,
                                bool counts_as_dropped) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::int64_t growth = Raise((counts_as_dropped ? kDroppedPrefix : "") + name, value);
  if (counts_as_dropped) totals_.num_dropped += growth;
}

void StatusReporter::SetGauge(const std::string& name, std::int64_t value) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Counter(name) = value;
}

void StatusReporter::SetSectionCounters(const std::string& name, const SectionCounters& counters) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string dropped = kDroppedPrefix + name;
  totals_.num_dropped += Raise(dropped + " incomplete", counters.incomplete);
  totals_.num_dropped += Raise(dropped + " conflicting", counters.conflicting);
  totals_.num_dropped += Raise(dropped + " of the name of another", counters.same_name);
  totals_.num_rejected +=
      Raise(kRejectedPrefix + name + ": sections with bad numbers", counters.bad_numbers);
  Raise(name + " sections duplicated", counters.duplicated);
  Raise(name + " sections late", counters.late);
}

void StatusReporter::AddStageTimes(const StageTimes& times) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& [stage, ms] : times) {
    auto known = std::find_if(stage_times_.begin(), stage_times_.end(),
                              [&stage = stage](const auto& item) { return item.first == stage; });
    if (known == stage_times_.end()) {
      if (stage_times_.size() >= kMaxNames) continue;
      known = stage_times_.insert(stage_times_.end(), {stage, {}});
    }
    known->second.push_back(ms);
    if (known->second.size() > kMedianScans) known->second.pop_front();
  }
}

void StatusReporter::ReportError(const std::string& kind, const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  LogOnce(kind, text);
}

SubscriptionObserver StatusReporter::MakeObserver() {
  SubscriptionObserver observer;
  observer.on_received = [this](const std::string&) { CountIn(); };
  observer.on_rejected = [this](const std::string& channel, const std::string& cause) {
    CountRejected(channel, cause);
  };
  return observer;
}

void StatusReporter::PublishIfDue() {
  const auto now = tempo_.Now();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (now < next_publish_) return;
    next_publish_ = std::max(next_publish_ + kPeriod, now);
  }
  Publish();
}

void StatusReporter::Publish() {
  const std::vector<std::uint8_t> bytes = EncodeMessage(Snapshot());
  lcm_->publish(channel_, bytes.data(), static_cast<unsigned int>(bytes.size()));
}

status_t StatusReporter::Snapshot() const {
  const ProcessUsage usage = CurrentProcessUsage();
  const std::lock_guard<std::mutex> lock(mutex_);
  status_t status = totals_;
  status.utime = WallClockUtime();
  for (const auto& [name, value] : counters_) AddCounter(name, value, &status);
  AddCounter(kCpuCounter, usage.cpu_ms, &status);
  AddCounter(kMemoryCounter, usage.memory_kb, &status);
  AddCounter(kPeakMemoryCounter, usage.peak_memory_kb, &status);
  for (const auto& [stage, times] : stage_times_) {
    stage_time_t stage_time;
    stage_time.stage = Trimmed(stage);
    stage_time.ms = Median(times);
    status.stage_times.push_back(std::move(stage_time));
  }
  status.num_counters = static_cast<std::int32_t>(status.counters.size());
  status.num_stage_times = static_cast<std::int32_t>(status.stage_times.size());
  return status;
}

std::int64_t& StatusReporter::Counter(const std::string& name) {
  const auto known = counters_.find(Trimmed(name));
  if (known != counters_.end()) return known->second;
  if (counters_.size() >= kMaxNames) return counters_["other"];
  return counters_[Trimmed(name)];
}

std::int64_t StatusReporter::Raise(const std::string& name, std::int64_t value) {
  std::int64_t& counter = Counter(name);
  const std::int64_t growth = std::max<std::int64_t>(0, value - counter);
  counter += growth;
  return growth;
}

void StatusReporter::LogOnce(const std::string& kind, const std::string& text) {
  totals_.last_error = Trimmed(text);
  if (logged_.size() >= kMaxNames || !logged_.insert(Trimmed(kind)).second) return;
  spdlog::warn("{} (told once; RIMOD_STATUS counts)", Trimmed(text));
}

}  // namespace rimod
