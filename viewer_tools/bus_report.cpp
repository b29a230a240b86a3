#include "viewer_tools/bus_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "viewer_tools/text_table.h"

namespace rimod {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMsPerSecond = 1e3;
constexpr double kSilent = 3.0;  // s: a status should come once a second

const char* OriginText(LatencyOrigin origin) {
  switch (origin) {
    case LatencyOrigin::kLastLine:
      return "the scan's last laser line";
    case LatencyOrigin::kScan:
      return "the scan's first message";
    case LatencyOrigin::kFirstOutput:
      return "the first message heard of the scan";
  }
  return "";
}

std::string OrDash(const std::optional<double>& value, int decimals) {
  return value ? FormatNumber(*value, decimals) : "-";
}

std::string Megabytes(const std::optional<std::int64_t>& kb) {
  return kb ? FormatNumber(static_cast<double>(*kb) / 1024.0, 1) : "-";
}

// Waiting scans, and behind the plus waiting messages.
std::string Queue(const ProcessReport& process) {
  if (!process.waiting_scans && !process.waiting_messages) return "-";
  return std::to_string(process.waiting_scans.value_or(0)) + "+" +
         std::to_string(process.waiting_messages.value_or(0));
}

std::string FormatProcesses(const std::vector<ProcessReport>& processes) {
  std::vector<TextRow> rows = {{"process", "host", "pid", "out/s", "cpu [%]", "mem [MB]",
                                "peak [MB]", "queue", "in", "out", "dropped", "rejected", ""}};
  for (const ProcessReport& process : processes) {
    const bool silent = process.silence > kSilent;
    rows.push_back({Printable(process.process), Printable(process.host),
                    std::to_string(process.pid), OrDash(process.out_per_second, 2),
                    process.cpu_share ? FormatNumber(100.0 * *process.cpu_share, 1) : "-",
                    Megabytes(process.memory_kb), Megabytes(process.peak_memory_kb), Queue(process),
                    std::to_string(process.num_in), std::to_string(process.num_out),
                    std::to_string(process.num_dropped), std::to_string(process.num_rejected),
                    silent ? "silent for " + FormatNumber(process.silence, 0) + " s" : ""});
  }
  return FormatRows(rows);
}

std::string FormatChannels(const std::vector<ChannelReport>& channels) {
  std::vector<TextRow> rows = {{"channel", "messages", "wholes", "wholes/s", "kB/s", "p50 [ms]",
                                "p95 [ms]", "max [ms]", "of scans"}};
  for (const ChannelReport& channel : channels) {
    TextRow row = {channel.channel, std::to_string(channel.num_messages),
                   std::to_string(channel.num_wholes), FormatNumber(channel.wholes_per_second, 2),
                   FormatNumber(channel.bytes_per_second / 1e3, 1)};
    if (channel.latency && channel.latency->num_scans > 0) {
      for (const double latency :
           {channel.latency->p50, channel.latency->p95, channel.latency->max})
        row.push_back(FormatNumber(kMsPerSecond * latency, 1));
      row.push_back(std::to_string(channel.latency->num_scans));
    }
    rows.push_back(std::move(row));
  }
  return FormatRows(rows);
}

std::string FormatLosses(const BusReport& report) {
  std::vector<TextRow> rows;
  const auto add = [&rows](const std::string& who, const std::string& what,
                           const NamedCounts& counts) {
    for (const auto& [cause, count] : counts)
      rows.push_back({Printable(who) + ": " + what + Printable(cause), std::to_string(count)});
  };
  for (const ProcessReport& process : report.processes) {
    add(process.process, "dropped ", process.drops);
    add(process.process, "rejected ", process.rejections);
  }
  add("rimod-top", "cannot read ", report.unusable);
  if (rows.empty()) return "  nothing dropped or rejected\n";
  rows.insert(rows.begin(), {"lost, by cause", "number"});
  return FormatRows(rows);
}

std::string FormatErrors(const std::vector<ProcessReport>& processes) {
  std::string text;
  for (const ProcessReport& process : processes)
    if (!process.last_error.empty())
      text += "  " + Printable(process.process) + ": " + Printable(process.last_error) + "\n";
  return text.empty() ? "" : "\n  last error\n" + text;
}

Json CountsJson(const NamedCounts& counts) {
  Json json = Json::object();
  for (const auto& [name, count] : counts) json[name] = count;
  return json;
}

template <typename Value>
Json OrNull(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

Json ProcessJson(const ProcessReport& process) {
  Json stages = Json::object();
  for (const auto& [stage, ms] : process.stage_ms) stages[stage] = ms;
  return {{"process", process.process},
          {"host", process.host},
          {"pid", process.pid},
          {"version", process.version},
          {"silence_s", process.silence},
          {"in", process.num_in},
          {"out", process.num_out},
          {"dropped", process.num_dropped},
          {"rejected", process.num_rejected},
          {"out_per_s", OrNull(process.out_per_second)},
          {"cpu_share", OrNull(process.cpu_share)},
          {"memory_kb", OrNull(process.memory_kb)},
          {"peak_memory_kb", OrNull(process.peak_memory_kb)},
          {"waiting_scans", OrNull(process.waiting_scans)},
          {"waiting_messages", OrNull(process.waiting_messages)},
          {"drops", CountsJson(process.drops)},
          {"rejections", CountsJson(process.rejections)},
          {"counters", CountsJson(process.counters)},
          {"stage_ms", std::move(stages)},
          {"last_error", process.last_error}};
}

Json ChannelJson(const ChannelReport& channel) {
  Json json = {{"channel", channel.channel},
               {"messages", channel.num_messages},
               {"wholes", channel.num_wholes},
               {"wholes_per_s", channel.wholes_per_second},
               {"bytes_per_s", channel.bytes_per_second},
               {"latency_ms", Json()}};
  if (channel.latency && channel.latency->num_scans > 0)
    json["latency_ms"] = {{"p50", kMsPerSecond * channel.latency->p50},
                          {"p95", kMsPerSecond * channel.latency->p95},
                          {"max", kMsPerSecond * channel.latency->max},
                          {"scans", channel.latency->num_scans}};
  return json;
}

}  // namespace

bool BusReport::empty() const {
  return processes.empty() &&
         std::all_of(channels.begin(), channels.end(),
                     [](const ChannelReport& channel) { return channel.num_messages == 0; });
}

std::string FormatBusReport(const BusReport& report) {
  std::vector<ProcessTimes> times;
  for (const ProcessReport& process : report.processes)
    times.push_back({process.process, process.stage_ms});
  return "rimod-top: " + FormatNumber(report.duration, 0) + " s; latency from " +
         OriginText(report.origin) + " to the last section of each output\n\n" +
         FormatProcesses(report.processes) + "\n" + FormatChannels(report.channels) + "\n" +
         FormatLosses(report) + FormatErrors(report.processes) + "\n" + FormatStageTimes(times);
}

std::string BusReportJson(const BusReport& report) {
  Json json = {{"duration_s", report.duration}, {"latency_from", OriginText(report.origin)}};
  json["processes"] = Json::array();
  for (const ProcessReport& process : report.processes)
    json["processes"].push_back(ProcessJson(process));
  json["channels"] = Json::array();
  for (const ChannelReport& channel : report.channels)
    json["channels"].push_back(ChannelJson(channel));
  json["unusable"] = CountsJson(report.unusable);
  // Text in messages need not be UTF-8.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace rimod
