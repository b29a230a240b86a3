#include "scanner_proc/live_scanner.h"

#include <algorithm>
#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <thread>

#include "io/laser_messages.h"
#include "io/status_reporter.h"
#include "scanner_proc/laser_scanner.h"
#include "scanner_proc/ray_caster.h"

namespace rimod::simulation {
namespace {

using Clock = std::chrono::steady_clock;

// A line and its pose take a few kilobytes of the 200 kB that a stock socket buffers: at this pace
// a receiver may be away for a tenth of a second.
constexpr auto kLeastTimePerLine = std::chrono::milliseconds(2);
constexpr auto kLate = std::chrono::milliseconds(100);
constexpr auto kNap = std::chrono::milliseconds(20);  // between looks at stop and status

std::int64_t NowUtime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

class LivePublisher {
 public:
  LivePublisher(const LaserScanner& scanner, double line_period, double speed,
                const Channels& channels, lcm::LCM* lcm)
      : scanner_(scanner),
        time_per_line_(speed > 0.0 ? line_period / speed : 0.0),
        channels_(channels),
        lcm_(lcm),
        status_(lcm, channels.status, "rimod-simulator"),
        start_(Clock::now()),
        next_(start_) {}

  // Returns false when stopped.
  bool PublishLine(std::int64_t index, const std::atomic<bool>& stop) {
    const LaserLine line = scanner_.Scan(index).line;
    if (!WaitFor(index, stop)) return false;
    PublishPose(index);
    Publish(channels_.laser, ToMessage(line));
    ++result_.num_lines;
    return true;
  }

  void PublishPose(std::int64_t index) {
    Publish(channels_.laser_to_local, ToMessage(scanner_.TimedPoseOf(index)));
  }

  bool WaitFor(std::int64_t index, const std::atomic<bool>& stop) {
    const std::chrono::duration<double> offset(time_per_line_ * static_cast<double>(index));
    const Clock::time_point planned = start_ + std::chrono::duration_cast<Clock::duration>(offset);
    const bool paced = time_per_line_ > 0.0;
    // After a delay what is late follows quickly, but not all at once.
    const Clock::time_point due = paced ? std::max(planned, next_) : next_;
    while (!stop && Clock::now() < due) {
      status_.PublishIfDue();
      std::this_thread::sleep_until(std::min(due, Clock::now() + Clock::duration(kNap)));
    }
    status_.PublishIfDue();
    if (paced && Clock::now() > planned + kLate) ++result_.num_late;
    next_ = Clock::now() + kLeastTimePerLine;
    return !stop;
  }

  LiveResult Finish() {
    status_.Publish();
    return result_;
  }

 private:
  template <typename Message>
  void Publish(const std::string& channel, const Message& message) {
    if (lcm_->publish(channel, &message) == 0) {
      status_.CountOut();
    } else {
      ++result_.num_failed;
      status_.ReportError("publish", "messages cannot be sent");
    }
  }

  const LaserScanner& scanner_;
  double time_per_line_;  // s; 0: no plan
  const Channels& channels_;
  lcm::LCM* lcm_;
  StatusReporter status_;
  Clock::time_point start_;
  Clock::time_point next_;  // earliest time of the next line
  LiveResult result_;
};

}  // namespace

LiveResult PublishSweeps(const Scene& scene, int num_sweeps, double speed, const Channels& channels,
                         lcm::LCM* lcm, const std::atomic<bool>& stop) {
  const RayCaster caster(scene.objects);
  const LaserScanner scanner(scene.sensor, scene.noise, caster, scene.seed, NowUtime());
  LivePublisher publisher(scanner, scene.sensor.line_period, speed, channels, lcm);
  std::int64_t line = 0;
  for (int sweep = 0; num_sweeps == 0 || sweep < num_sweeps; ++sweep) {
    const bool last = sweep + 1 == num_sweeps;
    const int num_lines = last ? scanner.num_lines() : scanner.LinesPerSweep();
    for (int i = 0; i < num_lines; ++i, ++line) {
      if (!publisher.PublishLine(line, stop)) return publisher.Finish();
    }
  }
  if (publisher.WaitFor(line, stop)) publisher.PublishPose(line);
  return publisher.Finish();
}

}  // namespace rimod::simulation
