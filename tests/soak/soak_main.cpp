// The pipeline for a long time under faults, in a private network: plays a log in a loop to
// assembler, extractor and matcher, which rimod-run keeps alive while they are killed and sections
// get lost, and compares every detection with the offline result.

#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>

#include "io/bus.h"
#include "io/process_options.h"
#include "tests/soak/soak_bus.h"
#include "tests/support/private_network.h"
#include "tests/support/temporary_folder.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

struct SoakOptions {
  std::string models, log;
  double minutes = 10.0, speed = 6.0;
  unsigned seed = 1;
};

std::string RunFileText(const SoakOptions& options) {
  return "processes:\n"
         "  - {name: assembler, command: [rimod-assembler]}\n"
         "  - {name: extractor, command: [rimod-extractor]}\n"
         "  - {name: matcher, command: [rimod-matcher, --models, '" +
         options.models +
         "']}\n"
         "first_pause: 0.2\nlongest_pause: 1\nsteady_time: 5\n";
}

// Plays the log once, so much later (us) than recorded, and then rests until its last scan's lines
// have clearly stopped.
void PlayLoop(const SoakLog& log, std::int64_t shift, double speed, lcm::LCM* lcm, SoakEar* ear,
              SoakFaults* faults, SoakFigures* figures) {
  const auto begin = Clock::now();
  const std::int64_t first = log.events.front().utime;
  std::set<std::int64_t> disturbed;
  for (const SoakLog::Event& event : log.events) {
    const std::chrono::duration<double, std::micro> offset(
        static_cast<double>(event.utime - first) / speed);
    const auto due = begin + std::chrono::duration_cast<Clock::duration>(offset);
    if (due > Clock::now()) ear->ListenUntil(due);
    faults->Act();
    const std::vector<std::uint8_t> bytes = Shifted(event, shift);
    lcm->publish(event.is_line ? "LASER" : "LASER_TO_LOCAL", bytes.data(),
                 static_cast<unsigned int>(bytes.size()));
    for (const auto& [utime, end] : log.scan_ends) {
      const bool goes_on = event.utime >= utime && event.utime <= end;
      if (goes_on) figures->OnSweep(utime + shift, log.scans.at(utime), Clock::now());
      if (goes_on && faults->disturbing()) disturbed.insert(utime + shift);
    }
  }
  const auto rest = Clock::now() + milliseconds(800);
  while (Clock::now() < rest) {
    ear->ListenUntil(Clock::now() + milliseconds(20));
    faults->Act();
    if (faults->disturbing()) disturbed.insert(log.scans.rbegin()->first + shift);
  }
  for (const std::int64_t utime : disturbed) figures->Disturb(utime);
}

int Soak(const SoakOptions& options, const std::atomic<bool>& stop) {
  TemporaryFolder folder;
  const SoakLog log = ReadSoakLog(options.log, options.models, folder.path());
  ChildProcess run({OwnFolder() + "/rimod-run", folder.Write("run.yaml", RunFileText(options))},
                   folder.PathOf("output"));
  lcm::LCM lcm(kDefaultLcmUrl);
  SoakFigures figures;
  SoakEar ear(&lcm, &figures);
  const auto ready = Clock::now() + std::chrono::seconds(30);
  while (figures.PidOf("rimod-matcher") == 0 && Clock::now() < ready)
    ear.ListenUntil(Clock::now() + milliseconds(100));
  ear.ListenUntil(Clock::now() + std::chrono::seconds(2));

  SoakFaults faults(options.seed, &figures);
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(60.0 * options.minutes));
  constexpr std::int64_t kPause = 2'000'000;  // us, by the lines' clock
  const std::int64_t period = log.events.back().utime - log.events.front().utime + kPause;
  std::int64_t shift = 0;
  for (; Clock::now() < end && !stop; shift += period)
    PlayLoop(log, shift, options.speed, &lcm, &ear, &faults, &figures);
  faults.Calm();
  ear.ListenUntil(Clock::now() + std::chrono::seconds(6));
  for (int loop = 0; loop < 2; ++loop, shift += period)
    PlayLoop(log, shift, options.speed, &lcm, &ear, &faults, &figures);
  // On a busy machine the last ones are still on their way.
  const auto longest = Clock::now() + std::chrono::seconds(60);
  do ear.ListenUntil(Clock::now() + std::chrono::seconds(3));
  while (figures.NumMissed() > 0 && Clock::now() < longest && !stop);
  run.Signal(SIGTERM);
  const std::optional<int> exit_code = run.Wait(std::chrono::seconds(10));

  std::cout << figures.Table() << std::endl;
  std::vector<std::string> failures = figures.Failures();
  if (exit_code != 0) failures.push_back("rimod-run did not end well: " + run.Output());
  for (const std::string& failure : failures) std::cerr << "FAILED: " << failure << "\n";
  return failures.empty() ? 0 : 1;
}

}  // namespace
}  // namespace rimod

int main(int argc, char** argv) {
  rimod::EnterPrivateNetwork(argv);
  const rimod::StopOnSignal signals;
  CLI::App app("Soaks the pipeline in faults; prints figures, ends with 1 when one is wrong.");
  rimod::SoakOptions options;
  app.add_option("--models", options.models, "Folder of models")->required();
  app.add_option("--log", options.log, "Log with LASER and LASER_TO_LOCAL")->required();
  app.add_option("--minutes", options.minutes, "How long");
  app.add_option("--speed", options.speed, "So many times faster than recorded");
  app.add_option("--seed", options.seed, "Of the kills");
  if (const auto exit_code = rimod::ParseCommandLine(&app, argc, argv)) return *exit_code;
  try {
    return rimod::Soak(options, signals.stop());
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
