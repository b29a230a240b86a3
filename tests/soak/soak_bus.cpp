#include "tests/soak/soak_bus.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "io/event_log.h"
#include "io/message_codec.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kMeanTimeBetweenKills = 12.0;  // s
constexpr double kMeanTimeOfLoss = 8.0;         // s, and as long without
// A restart: rimod-run's pause, loading the models, and the scan that the process missed.
constexpr auto kRestart = std::chrono::seconds(6);

const std::array<std::string, 3> kVictims = {"rimod-assembler", "rimod-extractor", "rimod-matcher"};

Clock::time_point In(double seconds) {
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

bool Shell(const std::string& command) { return std::system(command.c_str()) == 0; }

void Replay(const std::string& stage, const std::string& in, const std::string& out) {
  const std::string command =
      OwnFolder() + "/" + stage + " --replay '" + in + "' --out '" + out + "' 2>/dev/null";
  if (!Shell(command)) throw std::runtime_error("failed: " + command);
}

template <typename Message>
void ForEach(const std::string& path, const std::string& channel,
             const std::function<void(const Message&, const LogEvent&)>& use) {
  EventLogReader log(path);
  while (const std::optional<LogEvent> event = log.Next()) {
    if (event->channel != channel) continue;
    const Decoded<Message> decoded =
        DecodeMessage<Message>(event->bytes.data(), event->bytes.size());
    if (decoded.message) use(*decoded.message, *event);
  }
}

}  // namespace

std::string OwnFolder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path().string();
}

SoakEar::SoakEar(lcm::LCM* lcm, SoakFigures* figures) : lcm_(lcm) {
  constexpr int kPlenty = 10000;
  const SubscriptionObserver nobody = {nullptr, [](const std::string&, const std::string&) {}};
  subscriptions_.push_back(
      SubscribeTo<scan_t>(lcm, "RIMOD_SCAN", kPlenty, nobody, [figures](const scan_t& section) {
        figures->OnScan(section);
        return std::string();
      }));
  subscriptions_.push_back(SubscribeTo<feature_set_t>(lcm, "RIMOD_FEATURES", kPlenty, nobody,
                                                      [figures](const feature_set_t& section) {
                                                        figures->OnFeatures(section);
                                                        return std::string();
                                                      }));
  subscriptions_.push_back(SubscribeTo<detections_t>(lcm, "RIMOD_DETECTIONS", kPlenty, nobody,
                                                     [figures](const detections_t& message) {
                                                       figures->OnDetections(message, Clock::now());
                                                       return std::string();
                                                     }));
  subscriptions_.push_back(SubscribeTo<status_t>(lcm, "RIMOD_STATUS", kPlenty, nobody,
                                                 [figures](const status_t& status) {
                                                   figures->OnStatus(status);
                                                   return std::string();
                                                 }));
}

void SoakEar::ListenUntil(Clock::time_point end) {
  do {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    lcm_->handleTimeout(static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 20)));
  } while (Clock::now() < end);
}

SoakFaults::SoakFaults(unsigned seed, SoakFigures* figures)
    : random_(seed),
      figures_(figures),
      can_lose_(Shell("nft add table inet soak 2>/dev/null")),
      next_kill_(In(Seconds(kMeanTimeBetweenKills))),
      next_loss_change_(In(Seconds(kMeanTimeOfLoss))),
      last_fault_(Clock::now() - kRestart) {}

void SoakFaults::Act() {
  if (calm_) return;
  if (Clock::now() >= next_kill_) Kill();
  if (can_lose_ && Clock::now() >= next_loss_change_) SetLoss(!loses_);
}

void SoakFaults::Calm() {
  if (loses_) SetLoss(false);
  calm_ = true;
}

bool SoakFaults::disturbing() const { return loses_ || Clock::now() - last_fault_ < kRestart; }

void SoakFaults::Kill() {
  next_kill_ = In(Seconds(kMeanTimeBetweenKills));
  const std::string& victim = kVictims[std::uniform_int_distribution<std::size_t>(0, 2)(random_)];
  const int pid = figures_->PidOf(victim);
  if (pid <= 0 || kill(pid, SIGKILL) != 0) return;  // it is starting
  figures_->OnKill(victim);
  figures_->DisturbWhatIsUnderWay(Clock::now());
  last_fault_ = Clock::now();
}

// Of the sections that carry scans, images and features (lines and results are short) one in 200 is
// lost: every sixth scan or so.
void SoakFaults::SetLoss(bool wanted) {
  next_loss_change_ = In(Seconds(kMeanTimeOfLoss));
  last_fault_ = Clock::now();
  const std::string rule =
      wanted ? "nft 'add chain inet soak in { type filter hook input priority 0; }; "
               "add rule inet soak in udp dport 7667 meta length > 8000 "
               "numgen random mod 200 < 1 drop'"
             : "nft 'delete chain inet soak in'";
  if (!Shell(rule)) return;
  loses_ = wanted;
  if (wanted) figures_->DisturbWhatIsUnderWay(Clock::now());
}

SoakLog ReadSoakLog(const std::string& path, const std::string& models, const std::string& folder) {
  SoakLog log;
  Replay("rimod-assembler", path, folder + "/scans");
  Replay("rimod-extractor", folder + "/scans", folder + "/described");
  Replay("rimod-matcher --models '" + models + "'", folder + "/described", folder + "/detected");
  ForEach<scan_t>(folder + "/scans", "RIMOD_SCAN", [&log](const scan_t& scan, const LogEvent&) {
    log.scans[scan.utime].num_lines = scan.num_lines;
    log.scan_ends[scan.utime] = scan.utime_end;
  });
  ForEach<detections_t>(folder + "/detected", "RIMOD_DETECTIONS",
                        [&log](const detections_t& message, const LogEvent&) {
                          log.scans[message.utime].detections = SumWithoutTimes(message);
                        });
  if (log.scans.empty()) throw std::runtime_error(path + ": holds no scan");
  EventLogReader reader(path);
  while (std::optional<LogEvent> event = reader.Next()) {
    const bool is_line = event->channel == "LASER";
    if (!is_line && event->channel != "LASER_TO_LOCAL") continue;
    SoakLog::Event kept = {0, is_line, std::move(event->bytes)};
    for (std::size_t i = 8; i < 16; ++i) kept.utime = kept.utime * 256 + kept.bytes.at(i);
    log.events.push_back(std::move(kept));
  }
  return log;
}

// All messages begin with their fingerprint and utime, both of eight bytes, big-endian.
std::vector<std::uint8_t> Shifted(const SoakLog::Event& event, std::int64_t by) {
  std::vector<std::uint8_t> bytes = event.bytes;
  const auto utime = static_cast<std::uint64_t>(event.utime + by);
  for (std::size_t i = 0; i < 8; ++i)
    bytes[8 + i] = static_cast<std::uint8_t>(utime >> (56 - 8 * i));
  return bytes;
}

}  // namespace rimod
