#include "viewer_tools/view_command.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "io/bus.h"
#include "io/files.h"
#include "io/model_file.h"
#include "io/process_options.h"
#include "viewer_tools/png.h"
#include "viewer_tools/view_process.h"
#include "viewer_tools/view_sources.h"

namespace rimod {
namespace {

// The name with what file names had better not have replaced.
std::string FileNameOf(const ViewedScan& scan) {
  std::string name = scan.name.empty() ? "scan_" + std::to_string(scan.utime) : scan.name;
  if (scan.is_partial()) name += "_until_" + std::to_string(scan.known_until);
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '.' && c != '#'; },
      '_');
  return name + ".png";
}

// What a window does with the scans of a file: each is shown for a while, or until a key asks for
// the next.
class FileShow {
 public:
  FileShow(const ViewOptions& options, const std::vector<ObjectModel>& models,
           const std::atomic<bool>& stop)
      : options_(options), screen_(options, models), stop_(stop) {}

  // Returns false when the user has had enough.
  bool Show(ViewedScan scan) {
    screen_.state().Add(std::move(scan));
    if (screen_.state().paused()) StepToNewest();
    const auto until = Clock::now() + std::chrono::duration<double>(options_.interval);
    while (!Ended()) {
      screen_.Poll(kPollMs);
      if (screen_.state().TakeNextWish()) return true;
      if (!screen_.state().paused() && Clock::now() >= until) return !Ended();
    }
    return false;
  }

  // After the last scan: until the user ends it.
  void Linger() {
    while (!Ended()) {
      screen_.Poll(kPollMs);
      screen_.state().TakeNextWish();
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int kPollMs = 20;

  bool Ended() const { return stop_ || screen_.Ended(); }
  void StepToNewest() {
    screen_.state().HandleKey('n');
    screen_.state().TakeNextWish();
  }

  const ViewOptions& options_;
  ViewScreen screen_;
  const std::atomic<bool>& stop_;
};

int ReportedExitCode(const ViewOptions& options, const ViewSourceReport& report) {
  for (const std::string& warning : report.warnings) spdlog::warn("{}", warning);
  for (const std::string& error : report.errors) spdlog::error("{}", error);
  if (report.num_scans == 0 && report.errors.empty())
    spdlog::error("{}: no scan in it", options.source);
  return report.errors.empty() && report.num_scans > 0 ? 0 : 1;
}

int ShowFile(const ViewOptions& options, const std::vector<ObjectModel>& models) {
  const StopOnSignal signal;
  FileShow show(options, models, signal.stop());
  const ViewSourceReport report =
      ReadViewedScans(options.source, options.channels, options.configuration, models,
                      [&](ViewedScan scan) { return show.Show(std::move(scan)); });
  const int exit_code = ReportedExitCode(options, report);
  if (report.num_scans > 0) show.Linger();
  return exit_code;
}

int WriteFilePictures(const ViewOptions& options, const std::vector<ObjectModel>& models) {
  bool all_written = true;
  int num_written = 0;
  const ViewSourceReport report = ReadViewedScans(
      options.source, options.channels, options.configuration, models, [&](const ViewedScan& scan) {
        all_written &= SavePicture(scan, models, StyleFrom(options), options.output);
        return ++num_written < options.max_scans;
      });
  return std::max(ReportedExitCode(options, report), all_written ? 0 : 1);
}

int ViewLive(const ViewOptions& options, const std::vector<ObjectModel>& models) {
  const StopOnSignal signal;
  const std::unique_ptr<lcm::LCM> lcm = OpenLcm(options.lcm_url);
  if (!lcm) return 1;
  // Whoever looks must not take the processor away from those who work.
  setpriority(PRIO_PROCESS, 0, 10);
  ViewProcess process(lcm.get(), options, models);
  std::atomic<bool> stop{false};
  const auto on_idle = [&] {
    process.OnIdle();
    stop = signal.stop() || process.Done();
  };
  constexpr auto kIdlePeriod = std::chrono::milliseconds(20);
  if (!RunBus(lcm.get(), stop, on_idle, kIdlePeriod)) return 1;
  return process.failed() ? 1 : 0;
}

}  // namespace

ViewStyle StyleFrom(const ViewOptions& options) {
  ViewStyle style;
  style.layers = options.layers;
  return style;
}

bool SavePicture(const ViewedScan& scan, const std::vector<ObjectModel>& models,
                 const ViewStyle& style, const std::string& folder) {
  std::error_code cause;
  std::filesystem::create_directories(folder, cause);
  const std::string path = (std::filesystem::path(folder) / FileNameOf(scan)).string();
  ViewStyle saved = style;
  saved.for_screen = false;
  const std::string bytes = EncodePng(DrawView(scan, models, saved, "").canvas);
  const std::string error =
      bytes.empty() ? path + ": the picture cannot be encoded" : WriteFileAtomically(path, bytes);
  if (!error.empty()) {
    spdlog::error("{}", error);
    return false;
  }
  std::printf("%s\n", path.c_str());
  std::fflush(stdout);
  return true;
}

int RunView(const ViewOptions& options) {
  if (options.output.empty()) {
    const std::string reason = ViewWindow::WhyNot();
    if (!reason.empty()) {
      spdlog::error("{}", reason);
      return 1;
    }
  }
  ModelFolder folder;
  if (!options.models.empty()) folder = LoadModelFolder(options.models);
  for (const std::string& error : folder.bad_files) spdlog::error("{}", error);
  if (!folder.error.empty()) {
    spdlog::error("{}", folder.error);
    return 1;
  }
  const int exit_code = options.source.empty()   ? ViewLive(options, folder.models)
                        : options.output.empty() ? ShowFile(options, folder.models)
                                                 : WriteFilePictures(options, folder.models);
  return folder.bad_files.empty() ? exit_code : 1;
}

}  // namespace rimod
