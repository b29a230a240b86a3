#include "io/log_replay.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "io/bus.h"
#include "io/files.h"
#include "io/process_usage.h"
#include "io/status_counters.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::microseconds;

// More than any parameter of a process that waits: whatever waits at the end of the log is done.
constexpr std::int64_t kLongest = 7'200'000'000;  // us

// A process on the bus looks at what waits as often as this.
constexpr auto kIdlePeriod = std::chrono::milliseconds(10);

constexpr int kDone = 0;
constexpr int kFailed = 1;

double Milliseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

bool AreSameFile(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return std::filesystem::equivalent(a, b, ignored);
}

std::string CheckOutput(const ReplayOptions& options) {
  for (const std::string& output : {options.out, options.timing})
    if (!output.empty() && AreSameFile(output, options.log))
      return output + ": is the log that is replayed: nothing is written there";
  return "";
}

std::string ListOf(const StageTimes& times) {
  std::string text;
  for (const auto& [stage, ms] : times)
    text += (text.empty() ? "" : ", ") + fmt::format("{} {:.1f}", stage, ms);
  return text;
}

}  // namespace

void AddReplayOptions(CLI::App* app, ReplayOptions* options) {
  CLI::Option* const replay =
      app->add_option("--replay", options->log,
                      "Work through this log of lcm-logger at full speed, without a network, and "
                      "end;\nmilliseconds a stage and scan go to stderr")
          ->type_name("LOG")
          ->excludes("--lcm-url");
  app->add_option("--out", options->out,
                  "With --replay: write what would be sent to this log, with the input's times")
      ->type_name("LOG")
      ->needs(replay);
  app->add_option("--timing", options->timing,
                  "With --replay: write the milliseconds of every stage of every scan there")
      ->type_name("FILE.json")
      ->needs(replay);
}

BusOptions BusForReplay(BusOptions bus, const ReplayOptions& replay) {
  if (replay.wanted()) bus.lcm_url = "memq://";
  return bus;
}

LogReplay::LogReplay(ReplayOptions options, lcm::LCM* lcm,
                     const std::vector<std::string>& out_channels,
                     const std::string& status_channel)
    : options_(std::move(options)),
      lcm_(lcm),
      own_channels_(out_channels.begin(), out_channels.end()) {
  own_channels_.insert(status_channel);
  constexpr int kAny = 1;  // memq:// has no capacity
  for (const std::string& channel : out_channels) {
    subscriptions_.push_back(std::make_unique<BytesSubscription>(
        lcm, channel, kAny, SubscriptionObserver(),
        [this, channel](const void* bytes, std::size_t size) {
          ++num_sent_;
          if (writer_) writer_->Write(event_time_.value_or(0), channel, bytes, size);
        }));
  }
  SubscriptionObserver observer;
  observer.on_rejected = [](const std::string&, const std::string&) {};
  subscriptions_.push_back(
      SubscribeTo<status_t>(lcm, status_channel, kAny, observer,
                            [this](status_t status) { return OnStatus(std::move(status)); }));
}

Tempo LogReplay::tempo() {
  return {[this] { return now_; },
          [this](std::int64_t utime, const StageTimes& times) { OnStageTimes(utime, times); }};
}

int LogReplay::Run(const std::atomic<bool>& stop, const std::function<void()>& on_idle) {
  const std::string bad_output = CheckOutput(options_);
  if (!bad_output.empty()) {
    spdlog::error("{}", bad_output);
    return kFailed;
  }
  if (!options_.out.empty()) writer_.emplace(options_.out);
  EventLogReader log(options_.log);
  const auto begin = Clock::now();
  on_idle();
  while (const std::optional<LogEvent> event = stop ? std::nullopt : log.Next()) {
    Advance(event->utime, on_idle);
    Handle(*event);
  }
  now_ += microseconds(kLongest);
  on_idle();
  HandleWaiting();
  now_ += microseconds(kLongest);
  on_idle();  // for the last status
  HandleWaiting();
  ReportTimes(Milliseconds(Clock::now() - begin));
  ReportLosses();
  if (!log.error().empty()) spdlog::error("{}", log.error());
  if (stop) {
    spdlog::error("{}: stopped: nothing was written", options_.log);
    return kFailed;
  }
  const bool used = status_ && status_->num_in > 0;
  if (!used && log.error().empty())
    spdlog::error("{}: holds nothing that this process listens to", options_.log);
  return WriteOutputs() && used && log.error().empty() ? kDone : kFailed;
}

// The log's clock goes on by what lies between two events, and stands still where that is negative.
// On the way the process looks at what waits as often as on the bus; of a long pause at its
// beginning, and at its end.
void LogReplay::Advance(std::int64_t utime, const std::function<void()>& on_idle) {
  constexpr int kLooks = 500;
  if (event_time_ && utime > *event_time_) {
    const std::uint64_t step =
        static_cast<std::uint64_t>(utime) - static_cast<std::uint64_t>(*event_time_);
    const Tempo::Time end = now_ + microseconds(static_cast<std::int64_t>(std::min<std::uint64_t>(
                                       step, static_cast<std::uint64_t>(kLongest))));
    for (int look = 0; look < kLooks && end - last_idle_ >= kIdlePeriod; ++look) {
      now_ = last_idle_ += kIdlePeriod;
      on_idle();
      HandleWaiting();
    }
    now_ = end;
    if (end - last_idle_ >= kIdlePeriod) {
      last_idle_ = end;
      on_idle();
      HandleWaiting();
    }
  }
  event_time_ = utime;
}

// What the log holds of this process's outputs, and of statuses, is not taken for its own.
void LogReplay::Handle(const LogEvent& event) {
  if (own_channels_.count(event.channel) > 0) return;
  lcm_->publish(event.channel, event.bytes.data(), static_cast<unsigned int>(event.bytes.size()));
  HandleWaiting();
}

// The event at hand, and what the process sends because of it.
void LogReplay::HandleWaiting() {
  while (lcm_->handleTimeout(0) > 0) {
  }
}

void LogReplay::OnStageTimes(std::int64_t utime, const StageTimes& times) {
  spdlog::info("scan {}: ms: {}", utime, ListOf(times));
  for (const auto& [stage, ms] : times) {
    auto known = std::find_if(stages_.begin(), stages_.end(),
                              [&stage = stage](const auto& item) { return item.first == stage; });
    if (known == stages_.end()) known = stages_.insert(stages_.end(), {stage, {}});
    known->second.push_back(ms);
  }
  if (!options_.timing.empty()) scans_.emplace_back(utime, times);
}

std::string LogReplay::OnStatus(status_t status) {
  status_ = std::move(status);
  return "";
}

void LogReplay::ReportTimes(double total_ms) const {
  spdlog::info("{}: {} messages in, {} out, {:.0f} ms, peak memory {} kB", options_.log,
               status_ ? status_->num_in : 0, num_sent_, total_ms,
               CurrentProcessUsage().peak_memory_kb);
  if (stages_.empty()) return;
  spdlog::info("{:<20} {:>6} {:>10} {:>10}", "stage", "scans", "median ms", "max ms");
  for (const auto& [stage, times] : stages_) {
    std::vector<double> sorted = times;
    std::sort(sorted.begin(), sorted.end());
    spdlog::info("{:<20} {:>6} {:>10.2f} {:>10.2f}", stage, sorted.size(),
                 sorted[sorted.size() / 2], sorted.back());
  }
}

void LogReplay::ReportLosses() const {
  if (!status_) return;
  for (const counter_t& counter : status_->counters) {
    const bool is_loss =
        counter.name.rfind(kDroppedPrefix, 0) == 0 || counter.name.rfind(kRejectedPrefix, 0) == 0;
    if (is_loss && counter.value > 0) spdlog::warn("{}: {}", counter.name, counter.value);
  }
}

bool LogReplay::WriteOutputs() {
  std::vector<std::string> errors;
  if (writer_) errors.push_back(writer_->Close());
  if (!options_.timing.empty()) {
    nlohmann::ordered_json scans = nlohmann::ordered_json::array();
    for (const auto& [utime, times] : scans_) {
      nlohmann::ordered_json ms = nlohmann::ordered_json::object();
      for (const auto& [stage, value] : times) ms[stage] = value;
      scans.push_back({{"scan", std::to_string(utime)}, {"ms", std::move(ms)}});
    }
    errors.push_back(WriteFileAtomically(options_.timing, scans.dump(1) + "\n"));
  }
  bool good = true;
  for (const std::string& error : errors) {
    if (error.empty()) continue;
    spdlog::error("{}", error);
    good = false;
  }
  return good;
}

ProcessRun::ProcessRun(const ReplayOptions& replay, lcm::LCM* lcm,
                       const std::vector<std::string>& out_channels,
                       const std::string& status_channel)
    : lcm_(lcm) {
  if (replay.wanted()) replay_.emplace(replay, lcm, out_channels, status_channel);
}

int ProcessRun::Run(const std::atomic<bool>& stop, const std::function<void()>& on_idle,
                    std::chrono::milliseconds idle_period) {
  if (replay_) return replay_->Run(stop, on_idle);
  return RunBus(lcm_, stop, on_idle, idle_period) ? 0 : 1;
}

}  // namespace rimod
