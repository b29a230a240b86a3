// Matchers that share the models and the fuser, as real processes: their result is that of the
// models of those that are there, to the bit, whoever dies, returns, overlaps or talks nonsense.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <memory>
#include <set>

#include "io/config.h"
#include "io/detection_messages.h"
#include "io/feature_messages.h"
#include "io/model_file.h"
#include "io/range_image_messages.h"
#include "io/shard_turn_messages.h"
#include "rimod/detector.h"
#include "tests/io/random_answers.h"
#include "tests/support/bus_probe.h"
#include "tests/support/child_process.h"
#include "tests/support/pile.h"
#include "tests/support/temporary_folder.h"

namespace rimod {
namespace {

using std::chrono::milliseconds;
using Names = std::vector<std::string>;

constexpr milliseconds kLong(60000);

class ShardsTest : public ::testing::Test {
 protected:
  // Two classes of one shape, which compete: only together is it known which of them is told.
  static void SetUpTestSuite() {
    models_ = std::make_unique<TemporaryFolder>();
    const PipelineParams params = Params();
    Recording recording = PileRecording();
    for (const std::string name : {"heap", "pile"}) {
      recording.class_name = name;
      const ObjectModel model = BuildModel(recording, params, Execution());
      ASSERT_EQ(WriteModelFile(models_->PathOf(name + ".rimod"), model), "");
    }
    const Scan scan = PileScan(Placed(2.2, 0.2, 0.0, 2.8));
    image_ = ComputeRangeImage(scan, params, Execution());
    features_ = ExtractFeatures(image_, params, Execution());
  }
  static void TearDownTestSuite() { models_.reset(); }

  static PipelineParams Params() { return DefaultConfiguration(Method::kDefault).pipeline; }

  // What comes of these models, each judged by itself.
  struct Expected {
    std::string detections, hypotheses;
  };
  static Expected Expect(const Names& names, std::int64_t utime) {
    std::vector<JudgedScan> parts;
    for (const std::string& name : names) {
      const ModelDatabase database({*ReadModelFile(models_->PathOf(name + ".rimod")).model},
                                   Params(), Execution());
      parts.push_back(JudgeObjects(image_, features_, database, Params(), Execution()));
    }
    const DetectionResult result = ChooseDetections(Joined(parts), Params());
    EXPECT_EQ(result.detections.size(), 1u);
    StampedDetections detections;
    detections.utime = utime;
    detections.T_local_sensor = image_.T_local_sensor();
    detections.num_models = static_cast<int>(names.size());
    detections.detections = result.detections;
    return {SumOf(EncodeMessage(ToMessage(detections))),
            SumOf(EncodeMessage(ToMessage(result.hypotheses, result.num_hypotheses_found, utime)))};
  }

  void Start(const std::string& name, const std::string& executable, const Names& more) {
    Names words = {std::string(RIMOD_BIN_DIR) + "/" + executable};
    words.insert(words.end(), more.begin(), more.end());
    processes_[name] = std::make_unique<ChildProcess>(words, folder_.PathOf(name));
  }
  void StartFuser() { Start("fuser", "rimod-fuser", {}); }
  void StartShard(const std::string& name, const Names& share) {
    Names words = {"--models", models_->path()};
    words.insert(words.end(), share.begin(), share.end());
    Start(name, "rimod-matcher", words);
  }
  void WaitForCounter(const std::string& counter, std::int64_t value) {
    ASSERT_TRUE(bus_.ListenUntil(
        [&] {
          const std::optional<status_t> status = bus_.Status("rimod-fuser");
          return status && CounterOf(*status, counter) == value;
        },
        kLong))
        << counter << " is not " << value << "\n"
        << processes_["fuser"]->Output();
  }
  void WaitForShards(std::int64_t number) { WaitForCounter("shards", number); }
  void StartAll() {
    StartFuser();
    StartShard("first", {"--shard", "1/2"});
    StartShard("second", {"--shard", "2/2"});
    WaitForShards(2);
  }

  // Sends the scan; its result must be that of these models.
  void ExpectResultOf(const Names& names) {
    ++utime_;
    bus_.PublishAll("RIMOD_RANGE_IMAGE", ToSections(image_, utime_));
    bus_.PublishAll("RIMOD_FEATURES", ToSections(features_, utime_));
    const auto result = [&] {
      std::vector<std::string> sums;
      for (detections_t& message : bus_.Messages<detections_t>("RIMOD_DETECTIONS")) {
        message.stage_times.clear();
        message.num_stage_times = 0;
        if (message.utime == utime_) sums.push_back(SumOf(EncodeMessage(message)));
      }
      return sums;
    };
    EXPECT_TRUE(bus_.ListenUntil([&] { return !result().empty(); }, kLong))
        << processes_["fuser"]->Output();
    bus_.Listen(milliseconds(300));
    const Expected expected = Expect(names, utime_);
    EXPECT_EQ(result(), Names{expected.detections});
    EXPECT_EQ(bus_.Sums("RIMOD_HYPOTHESES", utime_), Names{expected.hypotheses});
  }
  std::string LastError() {
    const std::optional<status_t> status = bus_.Status("rimod-fuser");
    return status ? status->last_error : "";
  }
  void ExpectLastError(const Names& words) {
    const auto has_all = [&] {
      const std::string error = LastError();
      return std::all_of(words.begin(), words.end(), [&](const std::string& word) {
        return error.find(word) != std::string::npos;
      });
    };
    EXPECT_TRUE(bus_.ListenUntil(has_all, milliseconds(10000))) << LastError();
  }

  static std::unique_ptr<TemporaryFolder> models_;
  static RangeImage image_;
  static FeatureSet features_;
  TemporaryFolder folder_;
  BusProbe bus_;
  std::int64_t utime_ = 0;
  std::map<std::string, std::unique_ptr<ChildProcess>> processes_;
};
std::unique_ptr<TemporaryFolder> ShardsTest::models_;
RangeImage ShardsTest::image_;
FeatureSet ShardsTest::features_;

TEST_F(ShardsTest, ADeadShardCostsItsModelsUntilItReturns) {
  StartAll();
  ExpectResultOf({"heap", "pile"});
  processes_["first"]->Signal(SIGKILL);
  ASSERT_EQ(processes_["first"]->Wait(kLong), 128 + SIGKILL);
  ExpectResultOf({"pile"});
  ExpectLastError({"1/2", "missing"});
  WaitForCounter("shards missing", 1);
  WaitForCounter("scans without shard 1/2", 1);
  ExpectResultOf({"pile"});
  StartShard("first", {"--shard", "1/2"});
  WaitForShards(2);
  WaitForCounter("shards missing", 0);
  ExpectResultOf({"heap", "pile"});
}

TEST_F(ShardsTest, ARestartedFuserKnowsItsShardsAtOnce) {
  StartAll();
  ExpectResultOf({"heap", "pile"});
  processes_["fuser"]->Signal(SIGKILL);
  ASSERT_EQ(processes_["fuser"]->Wait(kLong), 128 + SIGKILL);
  bus_.Forget();
  StartFuser();
  ASSERT_TRUE(bus_.ListenUntil([&] { return bus_.Status("rimod-fuser").has_value(); }, kLong));
  ExpectResultOf({"heap", "pile"});
}

TEST_F(ShardsTest, AModelThatTwoHaveCountsOnceAndIsReported) {
  StartAll();
  StartShard("by name", {"--only", "pile"});
  WaitForShards(3);
  ExpectResultOf({"heap", "pile"});
  ExpectLastError({"pile", "2/2"});
}

TEST_F(ShardsTest, OneWithOtherParametersIsLeftOutAndReported) {
  StartFuser();
  StartShard("good", {"--only", "pile"});
  StartShard("other", {"--only", "heap", "--config",
                       folder_.Write("other.yaml", "choice:\n  min_probability: 0.3\n")});
  WaitForShards(1);
  ExpectResultOf({"pile"});
  ExpectLastError({"heap", "other parameters"});
}

TEST_F(ShardsTest, NonsenseIsCountedAndHarmless) {
  StartAll();
  RandomValues random(1);
  Shard shard;
  shard.params = DigestOf(Params());
  std::vector<std::uint8_t> bytes = EncodeMessage(ToMessage(shard, 1));  // has no name
  bus_.Publish("RIMOD_SHARDS", bytes);
  bytes.resize(bytes.size() / 2);
  bus_.Publish("RIMOD_SHARDS", bytes);
  ShardAnswer answer = RandomAnswer(&random, "1/2", 3, 300);
  answer.shard.params = shard.params;
  std::vector<shard_candidates_t> sections = ToSections(answer);
  sections[0].candidates[0].score = -7.0;
  bus_.PublishAll("RIMOD_SHARD_CANDIDATES", sections);
  sections.pop_back();  // a whole that is never complete
  for (shard_candidates_t& section : sections) section.utime = 12345;
  bus_.PublishAll("RIMOD_SHARD_CANDIDATES", sections);
  for (int i = 0; i < 200; ++i) {  // whatever bits flip
    std::vector<std::uint8_t> flipped = EncodeMessage(ToSections(answer)[0]);
    for (int k = 0; k < 5; ++k)
      flipped[static_cast<std::size_t>(random.Int(8, 400))] ^=
          static_cast<std::uint8_t>(1 << random.Int(0, 7));
    bus_.Publish("RIMOD_SHARD_CANDIDATES", flipped);
    bus_.Listen(milliseconds(1));
  }
  // A shard that is none has every scan; turns of a fuser that is none, for a scan that is none.
  ShardScan scan = {answer.shard, 77, 88, true};
  scan.shard.name = "3/4";
  for (int i = 0; i < 50; ++i) {
    std::vector<std::uint8_t> flipped = EncodeMessage(ToMessage(scan));
    flipped[static_cast<std::size_t>(random.Int(8, 60))] ^= 0x10;
    bus_.Publish("RIMOD_SHARD_SCANS", flipped);
    bus_.Publish("RIMOD_SHARD_TURNS", ToMessage(ShardTurn{-1'000 - i, i - 10, 77, 88}));
    bus_.Listen(milliseconds(1));
  }
  ExpectResultOf({"heap", "pile"});
  EXPECT_TRUE(bus_.ListenUntil([&] { return bus_.Status("rimod-fuser")->num_rejected >= 3; },
                               milliseconds(10000)));
  EXPECT_TRUE(processes_["fuser"]->running());
}

// One shard is held up again and again, and scans come faster than either works.
TEST_F(ShardsTest, UnderOverloadAllShardsLeaveOutTheSameScans) {
  StartAll();
  ExpectResultOf({"heap", "pile"});
  bus_.Forget();
  // How many of a round become results is a matter of the machine: at least its newest.
  constexpr std::size_t kFewest = 3;
  const auto results = [this] { return bus_.Messages<detections_t>("RIMOD_DETECTIONS"); };
  int num_scans = 0;
  while (results().size() < kFewest && !HasFailure()) {
    for (int i = 0; i < 60; ++i, ++num_scans) {
      processes_["second"]->Signal(i % 4 < 2 ? SIGSTOP : SIGCONT);
      ++utime_;
      bus_.PublishAll("RIMOD_RANGE_IMAGE", ToSections(image_, utime_));
      bus_.PublishAll("RIMOD_FEATURES", ToSections(features_, utime_));
    }
    processes_["second"]->Signal(SIGCONT);
    ExpectResultOf({"heap", "pile"});  // the newest is among them
  }
  std::int64_t num_fused = 0, num_of_all = 0;
  for (const detections_t& message : results()) {
    ++num_fused;
    num_of_all += message.num_models == 2;
  }
  EXPECT_GE(10 * num_of_all, 9 * num_fused) << num_of_all << " of " << num_fused;
  const auto num_overtaken = [this] {
    std::map<int, std::int64_t> of_pids;
    for (const status_t& status : bus_.Messages<status_t>("RIMOD_STATUS"))
      if (status.process == "rimod-matcher")
        of_pids[status.pid] = CounterOf(status, "scans overtaken");
    return of_pids;
  };
  EXPECT_TRUE(bus_.ListenUntil(
      [&] {
        const auto of_pids = num_overtaken();
        return of_pids.size() == 2 &&
               std::all_of(of_pids.begin(), of_pids.end(), [&](const auto& item) {
                 return item.second >= num_scans - num_scans / 6 - num_fused;
               });
      },
      kLong))
      << "each tells what it left out";
}

TEST_F(ShardsTest, TwoFusersNoticeEachOtherAndTheShardsFollowOne) {
  StartAll();
  Start("second fuser", "rimod-fuser", {});
  std::set<pid_t> noticed;
  EXPECT_TRUE(bus_.ListenUntil(
      [&] {
        for (const status_t& status : bus_.Messages<status_t>("RIMOD_STATUS"))
          if (status.process == "rimod-fuser" &&
              CounterOf(status, "other senders on RIMOD_DETECTIONS") == 1 &&
              status.last_error.find("too many") != std::string::npos)
            noticed.insert(status.pid);
        return noticed ==
               std::set<pid_t>{processes_["fuser"]->pid(), processes_["second fuser"]->pid()};
      },
      kLong));
  for (const status_t& status : bus_.Messages<status_t>("RIMOD_STATUS"))
    if (status.process == "rimod-matcher") {
      EXPECT_EQ(status.last_error, "") << "shards are no twins";
    }
  processes_["second fuser"]->Signal(SIGTERM);
  EXPECT_EQ(processes_["second fuser"]->Wait(kLong), 0);
  ExpectResultOf({"heap", "pile"});
}

TEST_F(ShardsTest, ThePapersMethodIsRefusedWithAReason) {
  const std::string paper = folder_.Write("paper.yaml", "method: paper\n");
  Start("shard", "rimod-matcher",
        {"--models", models_->path(), "--shard", "1/2", "--config", paper});
  Start("fuser", "rimod-fuser", {"--config", paper});
  for (const std::string name : {"shard", "fuser"}) {
    EXPECT_EQ(processes_[name]->Wait(kLong), 2);
    EXPECT_NE(processes_[name]->Output().find("collisions"), std::string::npos);
  }
  Start("nonsense", "rimod-matcher", {"--shard", "5/4"});
  EXPECT_EQ(processes_["nonsense"]->Wait(kLong), 2);
}

}  // namespace
}  // namespace rimod
