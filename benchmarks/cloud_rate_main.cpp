// Publishes a recorded scan as point clouds at a steady rate and measures what rimod-extractor and
// rimod-matcher, which run beside it, make of them: benchmarks/cloud_rate starts all of it.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "io/cloud_messages.h"
#include "io/message_codec.h"
#include "io/process_options.h"
#include "io/raw_subscription.h"
#include "io/scan_source.h"
#include "rimod/detections_t.hpp"
#include "rimod/status_t.hpp"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::string scan;
  std::string channel = "CLOUD";
  std::string url = kDefaultLcmUrl;
  int num_points = 60000;
  double rate = 10.0;     // clouds a second
  double seconds = 30.0;  // of publishing
};

// The scan's points in its sensor's frame, evenly thinned to the number.
SensorCloud Thinned(const Scan& scan, int num_points) {
  const Eigen::Isometry3d T_sensor_local = scan.T_local_sensor.inverse();
  const std::size_t size = scan.points.size();
  const std::size_t count = std::min(size, static_cast<std::size_t>(num_points));
  SensorCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d p_local = scan.points[i * size / count].cast<double>();
    cloud.points.push_back((T_sensor_local * p_local).cast<float>());
  }
  return cloud;
}

double Percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

// Counts what comes back.
class Watcher {
 public:
  explicit Watcher(lcm::LCM* lcm) {
    const SubscriptionObserver observer = {[](const std::string&) {},
                                           [](const std::string&, const std::string&) {}};
    constexpr int kPlenty = 1000;
    detections_ = SubscribeTo<detections_t>(
        lcm, "RIMOD_DETECTIONS", kPlenty, observer, [this](const detections_t& message) {
          const auto sent = sent_.find(message.utime);
          if (sent == sent_.end()) return std::string("of another sender");
          const std::chrono::duration<double, std::milli> latency = Clock::now() - sent->second;
          latencies_ms.push_back(latency.count());
          num_objects += message.num_detections;
          sent_.erase(sent_.begin(), std::next(sent));  // older ones were overtaken
          return std::string();
        });
    statuses_ = SubscribeTo<status_t>(lcm, "RIMOD_STATUS", kPlenty, observer,
                                      [this](const status_t& status) {
                                        last_status[status.process] = status;
                                        return std::string();
                                      });
  }

  void Sent(std::int64_t utime) {
    waiting.push_back(static_cast<double>(sent_.size()));
    sent_[utime] = Clock::now();
  }

  std::vector<double> latencies_ms;
  std::vector<double> waiting;  // clouds under way when the next was sent
  std::int64_t num_objects = 0;
  std::map<std::string, status_t> last_status;

 private:
  std::map<std::int64_t, Clock::time_point> sent_;  // by utime, not answered yet
  std::unique_ptr<BytesSubscription> detections_, statuses_;
};

void HandleUntil(lcm::LCM* lcm, Clock::time_point end) {
  while (Clock::now() < end) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() < 1) {
      std::this_thread::sleep_until(end);
      return;
    }
    lcm->handleTimeout(static_cast<int>(left.count()));
  }
}

void Report(const Options& options, int num_sent, double seconds, const Watcher& watcher) {
  const std::vector<double>& ms = watcher.latencies_ms;
  const double answered = static_cast<double>(ms.size());
  std::printf("clouds of %d points: %d sent at %.1f a second, %zu answered (%.1f a second), ",
              options.num_points, num_sent, options.rate, ms.size(), answered / seconds);
  std::printf("%.1f objects each\n",
              static_cast<double>(watcher.num_objects) / std::max(1.0, answered));
  std::printf("from sending a cloud to receiving its detections: median %.0f ms, 95 %% %.0f, ",
              Percentile(ms, 0.5), Percentile(ms, 0.95));
  std::printf("most %.0f\n", Percentile(ms, 1.0));
  std::printf("clouds under way when the next is sent: median %.0f, most %.0f\n",
              Percentile(watcher.waiting, 0.5), Percentile(watcher.waiting, 1.0));
  for (const auto& [process, status] : watcher.last_status) {
    std::printf("%s: out %lld, dropped %lld", process.c_str(),
                static_cast<long long>(status.num_out), static_cast<long long>(status.num_dropped));
    for (const counter_t& counter : status.counters) {
      if (counter.name == "dropped scans overtaken" || counter.name == "clouds")
        std::printf(", %s %lld", counter.name.c_str(), static_cast<long long>(counter.value));
    }
    for (const stage_time_t& time : status.stage_times) {
      if (time.stage == "total") std::printf(", %.0f ms a scan (median)", time.ms);
    }
    std::printf("\n");
  }
}

int Run(const Options& options) {
  Scan scan;
  const ScanSourceReport report =
      ReadScans(options.scan, SweepParams(), [&](NamedScan read) { scan = std::move(read.scan); });
  for (const std::string& error : report.errors) std::fprintf(stderr, "%s\n", error.c_str());
  if (report.num_scans == 0) return 1;
  bot_core::pointcloud2_t message = ToMessage(Thinned(scan, options.num_points), "scanner");
  lcm::LCM lcm(options.url);
  if (!lcm.good()) return 1;
  Watcher watcher(&lcm);
  const auto begin = Clock::now();
  const int num_sent = static_cast<int>(options.seconds * options.rate);
  for (int i = 0; i < num_sent; ++i) {
    const std::chrono::duration<double> since_begin(i / options.rate);
    HandleUntil(&lcm, begin + std::chrono::duration_cast<Clock::duration>(since_begin));
    message.utime = std::chrono::duration_cast<std::chrono::microseconds>(
                        std::chrono::system_clock::now().time_since_epoch())
                        .count();
    message.seq = i;
    watcher.Sent(message.utime);
    const std::vector<std::uint8_t> bytes = EncodeMessage(message);
    lcm.publish(options.channel, bytes.data(), static_cast<unsigned int>(bytes.size()));
  }
  HandleUntil(&lcm, Clock::now() + std::chrono::milliseconds(2500));
  Report(options, num_sent, options.seconds, watcher);
  return watcher.latencies_ms.empty() ? 1 : 0;
}

}  // namespace
}  // namespace rimod

int main(int argc, char** argv) {
  CLI::App app("Sends point clouds at a steady rate and measures when their detections come.");
  rimod::Options options;
  app.add_option("scan", options.scan, "Scan file or log whose last scan is sent")->required();
  app.add_option("--channel", options.channel, "The extractor's --cloud-channel");
  app.add_option("-l,--lcm-url", options.url, "Where to speak LCM");
  app.add_option("--points", options.num_points, "Of a cloud")->check(CLI::Range(1, 1000000));
  app.add_option("--rate", options.rate, "Clouds a second")->check(CLI::Range(0.1, 1000.0));
  app.add_option("--seconds", options.seconds, "Of sending")->check(CLI::Range(1.0, 3600.0));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return rimod::Run(options);
}
