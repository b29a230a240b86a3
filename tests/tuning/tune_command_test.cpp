#include "tuning/tune_command.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/model_file.h"
#include "io/point_cloud_file.h"
#include "io/pose_messages.h"
#include "tests/support/pile.h"
#include "tests/support/temporary_folder.h"

namespace rimod {
namespace {

// Scans of the pile with labels, and its model and recording.
class TuneCommandTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    files_ = std::make_unique<TemporaryFolder>();
    std::filesystem::create_directory(files_->PathOf("models"));
    const ObjectModel model = BuildModel(PileRecording(), Settings().pipeline, Execution{});
    ASSERT_EQ(WriteModelFile(files_->PathOf("models/pile.rimod"), model), "");
    nlohmann::json labels = {{"scans", nlohmann::json::array()}};
    for (int i = 0; i < kScans; ++i) {
      const Eigen::Isometry3d pose = Placed(2.2 + 0.03 * i, 0.5 - 0.03 * i, 0.0, 3.5 + 0.02 * i);
      const std::string name = "scan" + std::to_string(i);
      ASSERT_EQ(WritePcd(files_->PathOf(name + ".pcd"), PileScan(pose)), "");
      const std::array<double, 4> q = QuaternionOf(pose);
      const Eigen::Vector3d p = pose.translation();
      labels["scans"].push_back(
          {{"scan", name},
           {"objects",
            {{{"class", "pile"}, {"pose", {p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]}}}}}});
    }
    files_->Write("labels.json", labels.dump());
  }
  static void TearDownTestSuite() { files_.reset(); }

  // The paper's method, so strict that nothing is found: there is something to be gained.
  static Configuration Settings() {
    Configuration configuration = DefaultConfiguration(Method::kPaper);
    configuration.pipeline.goodsac.max_trials = 5000;
    configuration.pipeline.validation.min_score = 0.99;
    return configuration;
  }

  static TuneOptions Options() {
    TuneOptions options;
    options.models = files_->PathOf("models");
    options.labels = files_->PathOf("labels.json");
    options.vary = {"validation.min_score=0.05..0.2"};
    options.num_trials = 3;
    options.num_folds = 2;
    options.num_threads = 1;
    options.out = files_->PathOf("best.yaml");
    options.csv = files_->PathOf("trials.csv");
    for (int i = 0; i < kScans; ++i)
      options.scans.push_back(files_->PathOf("scan" + std::to_string(i) + ".pcd"));
    return options;
  }

  struct Outcome {
    int exit_code = 0;
    std::string out;
  };
  static Outcome Tune(const TuneOptions& options, bool stopped = false) {
    const std::atomic<bool> stop{stopped};
    std::ostringstream out;
    const int exit_code = RunTune(options, Settings(), stop, out);
    return {exit_code, out.str()};
  }
  static int ExitCodeWith(const std::function<void(TuneOptions*)>& change) {
    TuneOptions options = Options();
    change(&options);
    return Tune(options).exit_code;
  }

  static constexpr int kScans = 4;
  static std::unique_ptr<TemporaryFolder> files_;
};
std::unique_ptr<TemporaryFolder> TuneCommandTest::files_;

TEST_F(TuneCommandTest, FindsWhatFindsTheObjectsWhateverTheThreads) {
  TuneOptions options = Options();
  options.even_if_unclear = true;  // four scans prove little
  const Outcome one = Tune(options);
  ASSERT_EQ(one.exit_code, 0) << one.out;
  EXPECT_NE(one.out.find("validation.min_score: 0.99 -> "), std::string::npos) << one.out;
  const std::string yaml = files_->Read("best.yaml");
  const ConfigurationResult best = ReadConfiguration(files_->PathOf("best.yaml"));
  ASSERT_TRUE(best.configuration) << best.error;
  EXPECT_LT(best.configuration->pipeline.validation.min_score, 0.99);
  EXPECT_EQ(best.configuration->pipeline.goodsac.max_trials, 5000);
  EXPECT_NE(yaml.find("Models stay as they are"), std::string::npos);
  const std::string csv = files_->Read("trials.csv");
  EXPECT_NE(csv.find("trial,validation.min_score,valid,scans,right"), std::string::npos);
  EXPECT_NE(csv.find("\n0,0.99,1,4,0,"), std::string::npos) << csv;

  options.num_threads = 3;
  EXPECT_EQ(Tune(options).exit_code, 0);
  EXPECT_EQ(
      ReadConfiguration(files_->PathOf("best.yaml")).configuration->pipeline.validation.min_score,
      best.configuration->pipeline.validation.min_score);
}

TEST_F(TuneCommandTest, WithoutAGainTheParametersStay) {
  TuneOptions options = Options();
  options.vary = {"validation.min_score=0.95..1"};
  options.num_trials = 2;
  const Outcome outcome = Tune(options);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.out.find("The parameters stay as they are"), std::string::npos) << outcome.out;
  EXPECT_EQ(ReadConfiguration(options.out).configuration->pipeline.validation.min_score, 0.99);
}

TEST_F(TuneCommandTest, BadUsageIsToldBeforeAnythingIsRead) {
  EXPECT_EQ(ExitCodeWith([](TuneOptions* o) { o->vary = {"no.parameter"}; }), 2);
  EXPECT_EQ(ExitCodeWith([](TuneOptions* o) { o->vary = {"validation.min_score=1..0"}; }), 2);
  EXPECT_EQ(ExitCodeWith([](TuneOptions* o) { o->vary.push_back(o->vary[0]); }), 2);
  EXPECT_EQ(ExitCodeWith([](TuneOptions* o) { o->vary = {"model_surface.point_spacing"}; }), 2);
  EXPECT_EQ(ExitCodeWith([](TuneOptions* o) { o->objective = "best"; }), 2);
}

TEST_F(TuneCommandTest, InputsThatCannotBeUsedEndIt) {
  EXPECT_EQ(ExitCodeWith([](TuneOptions* o) { o->labels = files_->PathOf("none.json"); }), 1);
  EXPECT_EQ(ExitCodeWith([](TuneOptions* o) { o->models = files_->PathOf("nowhere"); }), 1);
  EXPECT_EQ(ExitCodeWith([](TuneOptions* o) { o->scans[1] = files_->PathOf("none.pcd"); }), 1);
  EXPECT_EQ(ExitCodeWith([](TuneOptions* o) { o->scans[1] = o->scans[0]; }), 1);
  EXPECT_EQ(ExitCodeWith([](TuneOptions* o) { o->scans.resize(1); }), 1);  // no two folds
  const auto with_labels = [](const std::string& labels) {
    return ExitCodeWith([&](TuneOptions* o) { o->labels = files_->Write("other.json", labels); });
  };
  EXPECT_EQ(with_labels("{"), 1);
  EXPECT_EQ(with_labels(R"({"scans": []})"), 1);
  EXPECT_EQ(with_labels(R"({"scans": [{"scan": "other", "objects": []}]})"), 1);
  EXPECT_EQ(with_labels(R"({"scans": [{"scan": "scan0", "objects": []}]})"), 1);
  EXPECT_EQ(with_labels(R"({"scans": [{"scan": "scan0", "objects": [
      {"class": "ghost", "pose": [0, 0, 0, 1, 0, 0, 0]}]}]})"),
            1);
  EXPECT_EQ(with_labels(R"({"scans": [{"scan": "scan0", "objects": []},
                                      {"scan": "scan0", "objects": []}]})"),
            1);
  EXPECT_EQ(ExitCodeWith([](TuneOptions* o) {
              o->num_trials = 1;
              o->out = files_->PathOf("no/folder.yaml");
            }),
            1);
}

TEST_F(TuneCommandTest, StoppedEarlyItSaysSo) { EXPECT_EQ(Tune(Options(), true).exit_code, 1); }

TEST_F(TuneCommandTest, TheListNeedsNoInput) {
  TuneOptions options;
  options.list = true;
  const Outcome outcome = Tune(options);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.out.find("validation.min_score"), std::string::npos);
  EXPECT_EQ(outcome.out.find("bus."), std::string::npos);
}

TEST(TuneBudgetTest, TimesHaveAUnit) {
  EXPECT_EQ(SecondsFrom("90s"), 90.0);
  EXPECT_EQ(SecondsFrom("1.5min"), 90.0);
  EXPECT_EQ(SecondsFrom("2h"), 7200.0);
  for (const char* bad : {"", "20", "min", "0s", "-5s", "1d", "1e9h", "1..2s", "9999999h"})
    EXPECT_FALSE(SecondsFrom(bad)) << bad;
}

}  // namespace
}  // namespace rimod
