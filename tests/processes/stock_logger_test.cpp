// lcm-logger at stock settings (default URL, the kernel's default socket buffer) beside a sender of
// whole scans, on a machine whose processors are all busy.

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "io/event_log.h"
#include "io/paced_publisher.h"
#include "io/process_options.h"
#include "io/scan_messages.h"
#include "tests/io/random_values.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace rimod {
namespace {

// Keeps every processor busy.
class Load {
 public:
  explicit Load(unsigned num_threads) {
    for (unsigned i = 0; i < num_threads; ++i) {
      threads_.emplace_back([this] {
        volatile unsigned counter = 0;
        while (!stop_) counter = counter + 1;
      });
    }
  }
  ~Load() {
    stop_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

class StockLoggerTest : public ::testing::Test {
 protected:
  // Publishes scans while the logger runs; returns the utime and section of what it recorded.
  std::vector<std::pair<std::int64_t, int>> Record(int num_scans, const BusParams& params) {
    ChildProcess logger({"lcm-logger", "--quiet", folder_.PathOf("log")}, folder_.PathOf("said"));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    const std::unique_ptr<lcm::LCM> lcm = OpenLcm(kDefaultLcmUrl);
    {
      PacedPublisher publisher(lcm.get(), params);
      StampedScan scan;
      scan.scan = RandomValues(1).AScan(130000, 0);  // 27 sections, 1.6 MB
      for (int i = 1; i <= num_scans; ++i) {
        scan.utime = scan.utime_end = i;
        const std::vector<scan_t> sections = ToSections(scan);
        num_sections_ = static_cast<int>(sections.size());
        publisher.PublishAll("RIMOD_SCAN", sections);
        publisher.Flush();
      }
      EXPECT_EQ(publisher.num_failed(), 0);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    logger.Signal(SIGINT);
    EXPECT_EQ(logger.Wait(std::chrono::seconds(10)), 0) << logger.Output();

    std::vector<std::pair<std::int64_t, int>> recorded;
    EventLogReader reader(folder_.PathOf("log"));
    while (const std::optional<LogEvent> event = reader.Next()) {
      if (event->channel != "RIMOD_SCAN") continue;
      const auto decoded = DecodeMessage<scan_t>(event->bytes.data(), event->bytes.size());
      EXPECT_TRUE(decoded.message) << decoded.error;
      if (decoded.message) recorded.emplace_back(decoded.message->utime, decoded.message->section);
    }
    return recorded;
  }

  TemporaryFolder folder_;
  int num_sections_ = 0;
};

TEST_F(StockLoggerTest, RecordsEverySectionInOrderBesideABusyLoopAProcessor) {
  const Load load(std::thread::hardware_concurrency());
  constexpr int kNumScans = 15;
  const auto recorded = Record(kNumScans, BusParams());
  std::vector<std::pair<std::int64_t, int>> expected;
  for (int scan = 1; scan <= kNumScans; ++scan) {
    for (int section = 0; section < num_sections_; ++section) expected.emplace_back(scan, section);
  }
  EXPECT_EQ(recorded, expected);
}

}  // namespace
}  // namespace rimod
