#include "viewer_tools/top_command.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "io/bus.h"
#include "io/event_log.h"
#include "io/process_options.h"
#include "io/raw_subscription.h"
#include "viewer_tools/bus_watch.h"
#include "viewer_tools/terminal_screen.h"

namespace rimod {
namespace {

// Lines of some seconds, sections of some scans: taking one in takes microseconds.
constexpr int kQueueCapacity = 3000;

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string Format(const BusReport& report, const TopOptions& options) {
  return options.json ? BusReportJson(report) : FormatBusReport(report);
}

void Print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

using Subscriptions = std::vector<std::unique_ptr<BytesSubscription>>;

Subscriptions SubscribeWatch(lcm::LCM* lcm, BusWatch* watch) {
  Subscriptions subscriptions;
  SubscriptionObserver observer;
  observer.on_received = [](const std::string&) {};
  observer.on_rejected = [](const std::string&, const std::string&) {};  // the watch counts them
  for (const std::string& name : watch->channel_names())
    subscriptions.push_back(std::make_unique<BytesSubscription>(
        lcm, name, kQueueCapacity, observer, [watch, name](const void* bytes, std::size_t size) {
          watch->Take(name, bytes, size, Now());
        }));
  return subscriptions;
}

}  // namespace

int TopLive(const std::string& lcm_url, const Channels& channels, const TopOptions& options) {
  const StopOnSignal signal;
  const std::unique_ptr<lcm::LCM> lcm = OpenLcm(lcm_url);
  if (!lcm) return 1;
  BusWatch watch(channels, WatchSpan::kLately, options.clouds);
  const Subscriptions subscriptions = SubscribeWatch(lcm.get(), &watch);
  std::optional<TerminalScreen> screen;
  if (!options.once && !options.json) screen.emplace();
  const double begin = Now();
  double next_report = begin + (options.once ? options.listen : options.interval);
  std::atomic<bool> stop{false};
  const auto on_idle = [&] {
    stop = signal.stop().load();
    if (stop || Now() < next_report) return;
    next_report = std::max(next_report + options.interval, Now());
    if (options.once) {
      stop = true;
      return;
    }
    const std::string text = Format(watch.Report(Now()), options);
    if (screen) {
      screen->Show(text);
    } else {
      Print(text);
    }
  };
  if (!RunBus(lcm.get(), stop, on_idle)) return 1;
  if (!options.once) return 0;
  const BusReport report = watch.Report(Now());
  Print(Format(report, options));
  if (report.empty()) spdlog::error("heard nothing of the pipeline");
  return report.empty() ? 1 : 0;
}

int TopLog(const Channels& channels, const TopOptions& options) {
  EventLogReader log(options.log);
  BusWatch watch(channels, WatchSpan::kAll, options.clouds);
  double last = 0.0;
  bool first = true;
  while (const std::optional<LogEvent> event = log.Next()) {
    const double arrival = 1e-6 * static_cast<double>(event->utime);
    last = first ? arrival : std::max(last, arrival);  // a clock that was set back stands still
    first = false;
    watch.Take(event->channel, event->bytes.data(), event->bytes.size(), last);
  }
  if (!log.error().empty()) spdlog::error("{}", log.error());
  const BusReport report = watch.Report(last);
  if (report.empty()) {
    if (log.error().empty()) spdlog::error("{}: nothing of the pipeline", options.log);
    return 1;
  }
  Print(Format(report, options));
  return log.error().empty() ? 0 : 1;
}

}  // namespace rimod
