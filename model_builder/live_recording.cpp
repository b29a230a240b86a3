#include "model_builder/live_recording.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <utility>

#include "io/bus.h"
#include "io/files.h"
#include "io/point_cloud_file.h"
#include "io/raw_subscription.h"
#include "io/recording.h"
#include "io/scan_messages.h"
#include "io/section_joiner.h"
#include "io/status_reporter.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kBadUsage = 2;

// Scans in, files out.
class LiveRecorder {
 public:
  LiveRecorder(lcm::LCM* lcm, const Channels& channels, const BusParams& params, std::string folder,
               int num_scans)
      : folder_(std::move(folder)),
        num_wanted_(num_scans),
        joiner_(JoinerParamsFrom(params)),
        status_(lcm, channels.status, "rimod-modeler") {
    constexpr int kQueueCapacity = 1000;  // each scan counts; some may wait while one is written
    subscription_ =
        SubscribeTo<scan_t>(lcm, channels.scan, kQueueCapacity, status_.MakeObserver(),
                            [this](scan_t section) { return OnSection(std::move(section)); });
  }

  bool done() const { return num_recorded_ >= num_wanted_ || failed_; }
  bool failed() const { return failed_; }
  int num_recorded() const { return num_recorded_; }

  void OnIdle() {
    joiner_.GiveUpStale(Clock::now());
    status_.SetSectionCounters("scan", joiner_.counters());
    status_.PublishIfDue();
  }

 private:
  std::string OnSection(scan_t section) {
    const auto sections = joiner_.Add(std::move(section), Clock::now());
    if (!sections || done()) return "";
    const JoinedScan joined = JoinScanSections(*sections);
    if (!joined.scan) return joined.error;
    Record(*joined.scan);
    return "";
  }

  void Record(const StampedScan& scan) {
    const std::string name = fmt::format("scan_{:03d}.pcd", num_recorded_);
    const std::string path = (std::filesystem::path(folder_) / name).string();
    const std::string error = WritePcd(path, scan.scan);
    if (!error.empty()) {
      spdlog::error("{}", error);
      failed_ = true;
      return;
    }
    ++num_recorded_;
    status_.CountOut();
    spdlog::info("{}: {} points ({} of {} scans)", path, scan.scan.points.size(), num_recorded_,
                 num_wanted_);
  }

  const std::string folder_;
  const int num_wanted_;
  int num_recorded_ = 0;
  bool failed_ = false;
  SectionJoiner<scan_t> joiner_;
  StatusReporter status_;
  std::unique_ptr<BytesSubscription> subscription_;
};

// Why a folder cannot take a recording; empty when it can.
std::string CheckFolder(const std::string& folder) {
  const RecordingResult description = ReadRecordingDescription(folder);
  if (!description.recording) return description.error;
  const FolderListing scans = ListFolder(folder, "scan_", ".pcd");
  if (!scans.error.empty()) return scans.error;
  if (!scans.paths.empty()) return folder + ": holds scans already, build with --recording";
  return "";
}

}  // namespace

int RecordLive(const std::string& folder, int num_scans, const BusOptions& bus,
               const BusParams& params) {
  const StopOnSignal signals;
  const ChannelsResult channels = ChannelsFrom(bus);
  if (!channels.channels) {
    spdlog::error("{}", channels.error);
    return kBadUsage;
  }
  const std::string error = CheckFolder(folder);
  if (!error.empty()) {
    spdlog::error("{}", error);
    return kFailed;
  }
  const std::unique_ptr<lcm::LCM> lcm = OpenLcm(LcmUrl(bus));
  if (!lcm) return kFailed;
  LiveRecorder recorder(lcm.get(), *channels.channels, params, folder, num_scans);
  spdlog::info("waiting for {} scans on {}; Ctrl-C ends the recording", num_scans,
               channels.channels->scan);
  std::atomic<bool> stop = false;
  const bool bus_lives = RunBus(lcm.get(), stop, [&] {
    recorder.OnIdle();
    stop = signals.stop() || recorder.done();
  });
  if (!bus_lives) spdlog::error("LCM does not work any more");
  if (recorder.num_recorded() == 0) spdlog::error("{}: no scan came", folder);
  const bool usable = bus_lives && !recorder.failed() && recorder.num_recorded() > 0;
  return usable ? kDone : kFailed;
}

}  // namespace rimod
