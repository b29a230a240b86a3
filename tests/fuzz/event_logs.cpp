// Logs of lcm-logger and all that rimod-detect makes of them: events, lines, poses, sweeps, ready
// scans and point clouds.

#include "io/event_log.h"
#include "io/scan_source.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const rimod::InputFile file("log");
  const std::string& path = file.Write(bytes, size);
  std::size_t total = 0;
  rimod::EventLogReader log(path);
  while (const std::optional<rimod::LogEvent> event = log.Next())
    total += event->channel.size() + event->bytes.size();
  rimod::Require(total <= size, "events have no more bytes than their log");

  rimod::ScanSourceParams params;
  params.on_growth = [](const rimod::SweepGrowth&) {};
  for (const bool clouds : {false, true}) {
    if (clouds) params.cloud_channels = {"CLOUD", "POSE"};
    int num_scans = 0;
    const rimod::ScanSourceReport report =
        rimod::ReadScans(path, params, [&](const rimod::NamedScan&) { ++num_scans; });
    rimod::Require(report.num_scans == num_scans, "the number of scans");
    rimod::Require(num_scans > 0 || !report.errors.empty(), "a scan or an error");
  }
  return 0;
}
