#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "io/config.h"
#include "io/model_file.h"
#include "rimod/detector.h"
#include "tests/support/bus_probe.h"
#include "tests/support/child_process.h"
#include "tests/support/pile.h"
#include "tests/support/sample_messages.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tilting_laser.h"

namespace rimod {

using std::chrono::milliseconds;
using Bytes = std::vector<std::uint8_t>;

constexpr milliseconds kLong(30000);

// A detections message without what differs from run to run: the times.
inline Bytes WithoutTimes(detections_t message) {
  message.stage_times.clear();
  message.num_stage_times = 0;
  return EncodeMessage(message);
}

// A scan of a room with the pile somewhere, and what the stages make of it, computed here.
struct KnownScan {
  std::vector<scan_t> sections;
  std::vector<range_image_t> image;
  std::vector<feature_set_t> features;
  std::string detections;  // sum of the message without times
};

class FaultsTest : public ::testing::Test {
 protected:
  // The pile's model, and scans that differ: taken for one another, they give other results.
  static void SetUpTestSuite() {
    models_ = std::make_unique<TemporaryFolder>();
    const PipelineParams params = DefaultConfiguration(Method::kDefault).pipeline;
    ASSERT_EQ(WriteModelFile(models_->PathOf("pile.rimod"),
                             BuildModel(PileRecording(), params, Execution())),
              "");
    const ModelDatabase database(LoadModelFolder(models_->path()).models, params, Execution());
    for (int i = 0; i < 4; ++i) {
      StampedScan scan;
      scan.scan = PileScan(Placed(2.0 + 0.2 * i, 0.6 - 0.4 * i, 0.0, 3.5 - 0.7 * i));
      known_.push_back(Expect(scan, database, params));
    }
    ASSERT_GT(SumsOf(known_[0].sections).size(), 3u);
  }
  static void TearDownTestSuite() {
    models_.reset();
    known_.clear();
  }

  static KnownScan Expect(const StampedScan& scan, const ModelDatabase& database,
                          const PipelineParams& params) {
    KnownScan known;
    known.sections = ToSections(scan);
    const RangeImage image = ComputeRangeImage(scan.scan, params, Execution());
    const FeatureSet features = ExtractFeatures(image, params, Execution());
    known.image = ToSections(image, 0);
    known.features = ToSections(features, 0);
    StampedDetections detections;
    detections.T_local_sensor = image.T_local_sensor();
    detections.num_models = 1;
    detections.detections =
        DetectObjects(image, features, database, params, Execution()).detections;
    EXPECT_EQ(detections.detections.size(), 1u);
    known.detections = SumOf(WithoutTimes(ToMessage(detections)));
    return known;
  }

  void Start(const std::string& executable, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {
        std::string(RIMOD_BIN_DIR) + "/" + executable, "--config",
        folder_.Write("quick.yaml",
                      "bus:\n  idle_time: 0.3\n  join_patience: 0.3\n  max_waiting_scans: 100\n")};
    if (executable == "rimod-matcher") words.insert(words.end(), {"--models", models_->path()});
    words.insert(words.end(), more.begin(), more.end());
    processes_[executable] = std::make_unique<ChildProcess>(words, folder_.PathOf(executable));
  }
  bool Speaks(const std::string& executable) {
    const std::optional<status_t> status = bus_.Status(executable);
    return status && status->pid == processes_[executable]->pid();
  }
  void StartAndWait(const std::string& executable, const std::vector<std::string>& more = {}) {
    Start(executable, more);
    ASSERT_TRUE(bus_.ListenUntil([&] { return Speaks(executable); }, kLong))
        << processes_[executable]->Output();
  }

  // Each scan has a number, which is its utime.
  static const KnownScan& Known(std::int64_t utime) {
    return known_[static_cast<std::size_t>(utime) % known_.size()];
  }
  template <typename Message>
  static std::vector<Message> Stamped(std::vector<Message> sections, std::int64_t utime) {
    for (Message& section : sections) section.utime = utime;
    return sections;
  }
  static std::vector<scan_t> ScanSections(std::int64_t utime) {
    std::vector<scan_t> sections = Stamped(Known(utime).sections, utime);
    for (scan_t& section : sections) section.utime_end = utime;
    return sections;
  }

  // The scans of which detections came; all of these must be as expected.
  std::set<std::int64_t> Detected() {
    std::set<std::int64_t> detected;
    for (detections_t& message : bus_.Messages<detections_t>("RIMOD_DETECTIONS")) {
      const std::int64_t utime = message.utime;
      EXPECT_TRUE(detected.insert(utime).second) << "scan " << utime << " was detected twice";
      message.utime = 0;
      EXPECT_EQ(SumOf(WithoutTimes(message)), Known(utime).detections) << "scan " << utime;
    }
    return detected;
  }
  bool WaitForDetections(std::int64_t utime) {
    return bus_.ListenUntil(
        [&] {
          const auto all = bus_.Messages<detections_t>("RIMOD_DETECTIONS");
          return std::any_of(all.begin(), all.end(), [utime](const detections_t& message) {
            return message.utime == utime;
          });
        },
        kLong);
  }
  std::int64_t Counter(const std::string& executable, const std::string& name) {
    const std::optional<status_t> status = bus_.Status(executable);
    return status ? CounterOf(*status, name) : -1;
  }
  void ExpectAllRunning() {
    for (const auto& [name, process] : processes_)
      EXPECT_TRUE(process->running()) << name << ": " << process->Output();
  }

  static inline std::unique_ptr<TemporaryFolder> models_;
  static inline std::vector<KnownScan> known_;
  TemporaryFolder folder_;
  BusProbe bus_;
  std::map<std::string, std::unique_ptr<ChildProcess>> processes_;
};

}  // namespace rimod
