#include "detector_proc/detect_command.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "io/model_file.h"
#include "io/point_cloud_file.h"
#include "io/pose_messages.h"
#include "rimod/detector.h"
#include "tests/io/laser_logs.h"
#include "tests/support/matchers.h"
#include "tests/support/pile.h"
#include "tests/support/temporary_folder.h"

namespace rimod {
namespace {

using Json = nlohmann::json;

// A folder `models` with the pile's model, and scans of it.
class DetectCommandTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    files_ = std::make_unique<TemporaryFolder>();
    std::filesystem::create_directory(files_->PathOf("models"));
    const ObjectModel model = BuildModel(PileRecording(), Settings().pipeline, Execution{});
    ASSERT_EQ(WriteModelFile(files_->PathOf("models/pile.rimod"), model), "");
    ASSERT_EQ(WritePcd(files_->PathOf("first.pcd"), PileScan(FirstPose())), "");
    ASSERT_EQ(WritePcd(files_->PathOf("second.pcd"), PileScan(Placed(2.6, -0.6, 0.0, 2.2))), "");
    EventLogWriter swings(files_->PathOf("swings"));
    WriteSwings(2, &swings);
    ASSERT_EQ(swings.Close(), "");
  }
  static void TearDownTestSuite() { files_.reset(); }

  static Configuration Settings() { return DefaultConfiguration(Method::kPaper); }
  static Eigen::Isometry3d FirstPose() { return Placed(2.2, 0.5, 0.0, 3.5); }

  // Exit code and output of a run on files of the folder.
  struct Run {
    int exit_code = 0;
    std::string out;

    std::vector<Json> lines() const {
      std::vector<Json> lines;
      std::istringstream stream(out);
      for (std::string line; std::getline(stream, line);) lines.push_back(Json::parse(line));
      return lines;
    }
  };
  static Run Detect(const std::vector<std::string>& names, int num_threads = 1,
                    const std::string& models = "models", const std::string& timing = "") {
    DetectOptions options;
    options.models = files_->PathOf(models);
    options.num_threads = num_threads;
    options.timing = timing;
    for (const std::string& name : names) options.scans.push_back(files_->PathOf(name));
    std::ostringstream out;
    const int exit_code = RunDetect(options, Settings(), out);
    return {exit_code, out.str()};
  }

  static std::unique_ptr<TemporaryFolder> files_;
};
std::unique_ptr<TemporaryFolder> DetectCommandTest::files_;

TEST_F(DetectCommandTest, LinesTellScanClassPoseAndScoreInFullPrecision) {
  const Run run = Detect({"first.pcd"});
  EXPECT_EQ(run.exit_code, 0);
  ASSERT_EQ(run.lines().size(), 1u) << run.out;
  const Json line = run.lines()[0];
  EXPECT_EQ(line.size(), 4u);
  EXPECT_EQ(line["scan"], "first");
  EXPECT_EQ(line["class"], "pile");
  const std::vector<double> pose = line["pose"];
  ASSERT_EQ(pose.size(), 7u);
  const std::optional<Eigen::Isometry3d> T_local_object = PoseFrom(pose.data(), pose.data() + 3);
  ASSERT_TRUE(T_local_object);
  EXPECT_TRUE(PosesNear(*T_local_object, FirstPose(), 0.02, 0.02));

  const PipelineParams params = Settings().pipeline;
  const PointCloudResult cloud = ReadPointCloud(files_->PathOf("first.pcd"));
  const ModelFolder models = LoadModelFolder(files_->PathOf("models"));
  const ModelDatabase database(models.models, params, Execution{});
  const RangeImage image = ComputeRangeImage(*cloud.scan, params, Execution{});
  const DetectionResult expected = DetectObjects(image, ExtractFeatures(image, params, Execution{}),
                                                 database, params, Execution{});
  ASSERT_EQ(expected.detections.size(), 1u);
  EXPECT_EQ(line["score"].get<double>(), expected.detections[0].score);
  const Eigen::Vector3d position = expected.detections[0].T_local_object.translation();
  EXPECT_EQ(Eigen::Vector3d(pose.data()), position);
}

TEST_F(DetectCommandTest, ScansAreDoneInTheirOrderWhateverTheThreads) {
  const Run one = Detect({"second.pcd", "first.pcd"}, 1);
  ASSERT_GE(one.lines().size(), 1u);
  EXPECT_EQ(one.lines().back()["scan"], "first");
  EXPECT_EQ(Detect({"second.pcd", "first.pcd"}, 3).out, one.out);
  EXPECT_EQ(one.out, Detect({"second.pcd"}).out + Detect({"first.pcd"}).out);
}

TEST_F(DetectCommandTest, BadScansAreLeftOutAndTold) {
  files_->Write("empty.pcd", "");
  files_->Write("foreign", "nothing that we know");
  const Run run = Detect({"empty.pcd", "first.pcd", "none.pcd", "foreign", "models"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.out, Detect({"first.pcd"}).out);
}

TEST_F(DetectCommandTest, ATruncatedLogIsUsedAndTold) {
  const std::string bytes = files_->Read("swings");
  files_->Write("cut", bytes.substr(0, bytes.size() * 3 / 5));
  EXPECT_EQ(Detect({"swings"}).exit_code, 0);
  const std::string timing = files_->PathOf("cut.json");
  EXPECT_EQ(Detect({"cut"}, 1, "models", timing).exit_code, 1);
  EXPECT_EQ(Json::parse(files_->Read("cut.json")).size(), 1u);
}

TEST_F(DetectCommandTest, TimingTellsEveryStageOfEveryScan) {
  const std::string timing = files_->PathOf("timing.json");
  EXPECT_EQ(Detect({"first.pcd", "swings"}, 2, "models", timing).exit_code, 0);
  const Json entries = Json::parse(files_->Read("timing.json"));
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_EQ(entries[0]["scan"], "first");
  EXPECT_EQ(entries[1]["scan"], "swings#0");
  EXPECT_EQ(entries[2]["scan"], "swings#1");
  for (const Json& entry : entries) {
    EXPECT_GT(entry["points"].get<int>(), 100);
    const Json& ms = entry["ms"];
    double sum = 0.0;
    for (const char* stage : {"range_image", "interest_points", "descriptors", "matching",
                              "hypotheses", "scoring", "collisions", "validation"}) {
      ASSERT_TRUE(ms.contains(stage)) << stage;
      EXPECT_GE(ms[stage].get<double>(), 0.0);
    }
    for (const auto& [stage, time] : ms.items()) sum += stage == "total" ? 0.0 : time.get<double>();
    EXPECT_LE(sum, ms["total"].get<double>() + 1e-6);
    EXPECT_EQ(ms.contains("assembly"), entry["scan"] != "first");
  }
}

TEST_F(DetectCommandTest, AFolderWithoutModelsFindsNothing) {
  std::filesystem::create_directory(files_->PathOf("no models"));
  const Run run = Detect({"first.pcd"}, 1, "no models");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out, "");
}

TEST_F(DetectCommandTest, AMissingFolderOfModelsIsAnUnreadableInput) {
  const Run run = Detect({"first.pcd"}, 1, "nowhere");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.out, "");
}

TEST_F(DetectCommandTest, BadModelsAreLeftOutAndTold) {
  std::filesystem::create_directory(files_->PathOf("mixed"));
  const std::string good = files_->Read("models/pile.rimod");
  files_->Write("mixed/a_copy.rimod", good.substr(0, good.size() / 2));
  files_->Write("mixed/b_empty.rimod", "");
  files_->Write("mixed/c_good.rimod", good);
  const Run run = Detect({"first.pcd"}, 1, "mixed");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.out, Detect({"first.pcd"}).out);
}

TEST_F(DetectCommandTest, TheModelsFilesOrderDoesNotMatter) {
  ModelFileResult other = ReadModelFile(files_->PathOf("models/pile.rimod"));
  ASSERT_TRUE(other.model);
  other.model->name = "other";
  for (const auto& [folder, first, second] :
       {std::tuple("forth", "a", "b"), std::tuple("back", "b", "a")}) {
    std::filesystem::create_directory(files_->PathOf(folder));
    const std::string path = files_->PathOf(folder) + "/";
    std::filesystem::copy_file(files_->PathOf("models/pile.rimod"), path + first + ".rimod");
    ASSERT_EQ(WriteModelFile(path + second + ".rimod", *other.model), "");
  }
  EXPECT_EQ(Detect({"first.pcd", "second.pcd"}, 1, "forth").out,
            Detect({"first.pcd", "second.pcd"}, 2, "back").out);
}

TEST_F(DetectCommandTest, AnOutputThatCannotBeWrittenIsTold) {
  EXPECT_EQ(Detect({"swings"}, 1, "models", files_->PathOf("no/timing.json")).exit_code, 1);
  DetectOptions options;
  options.models = files_->PathOf("models");
  options.scans = {files_->PathOf("first.pcd")};
  std::ostringstream closed;
  closed.setstate(std::ios::badbit);
  EXPECT_EQ(RunDetect(options, Settings(), closed), 1);
}

}  // namespace
}  // namespace rimod
