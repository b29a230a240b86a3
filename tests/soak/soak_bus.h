#pragma once

#include <chrono>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "io/raw_subscription.h"
#include "tests/soak/soak_figures.h"
#include "tests/support/child_process.h"

namespace rimod {

// The soak's ear on the bus: what it hears goes to the figures.
class SoakEar {
 public:
  SoakEar(lcm::LCM* lcm, SoakFigures* figures);
  // Handles what comes until then.
  void ListenUntil(std::chrono::steady_clock::time_point end);

 private:
  lcm::LCM* lcm_;
  std::vector<std::unique_ptr<BytesSubscription>> subscriptions_;
};

// Kills and losses, from a seed.
class SoakFaults {
 public:
  SoakFaults(unsigned seed, SoakFigures* figures);
  ~SoakFaults() { Calm(); }
  SoakFaults(const SoakFaults&) = delete;
  SoakFaults& operator=(const SoakFaults&) = delete;

  // To be called often: does what is due.
  void Act();
  // Takes the losses away and kills no more.
  void Calm();
  // Whether something is lost now or was killed less than the time of a restart ago.
  bool disturbing() const;

 private:
  void Kill();
  void SetLoss(bool wanted);
  double Seconds(double mean) { return std::exponential_distribution<>(1.0 / mean)(random_); }

  std::mt19937 random_;
  SoakFigures* figures_;
  bool can_lose_ = false, loses_ = false, calm_ = false;
  std::chrono::steady_clock::time_point next_kill_, next_loss_change_, last_fault_;
};

// The lines and poses of a log, and what its scans give offline.
struct SoakLog {
  struct Event {
    std::int64_t utime = 0;  // of the measurement
    bool is_line = false;
    std::vector<std::uint8_t> bytes;
  };
  std::vector<Event> events;                   // in the log's order
  std::map<std::int64_t, ExpectedScan> scans;  // by utime
  std::map<std::int64_t, std::int64_t> scan_ends;
};

// Where this program and the processes are.
std::string OwnFolder();

// Reads a log and has its stages replayed, one after the other, into the folder. Throws
// std::runtime_error when that fails.
SoakLog ReadSoakLog(const std::string& path, const std::string& models, const std::string& folder);

// The event as of a later loop: its utime so much later (us).
std::vector<std::uint8_t> Shifted(const SoakLog::Event& event, std::int64_t by);

}  // namespace rimod
