#include "model_builder/modeler_command.h"

#include <gtest/gtest.h>

#include "io/model_file.h"
#include "io/point_cloud_file.h"
#include "tests/support/pile.h"
#include "tests/support/temporary_folder.h"

namespace rimod {
namespace {

constexpr char kDescription[] =
    R"({"class": "pile", "object_pose": [0, 0, 0, 1, 0, 0, 0],
        "box": {"min": [-0.4, -0.4, 0], "max": [0.4, 0.4, 0.95]}})";

Configuration FewViews() {
  Configuration configuration = DefaultConfiguration(Method::kPaper);
  configuration.pipeline.model_views.azimuths = 4;
  configuration.pipeline.model_views.elevations = 1;
  return configuration;
}

class ModelerCommandTest : public testing::Test {
 protected:
  void WriteRecording() {
    files_.Write("model.json", kDescription);
    const Recording recording = PileRecording();
    for (std::size_t i = 0; i < recording.scans.size(); ++i) {
      const std::string name = "scan_00" + std::to_string(i) + ".pcd";
      ASSERT_EQ(WritePcd(files_.PathOf(name), recording.scans[i]), "");
    }
  }
  // Points of the pile alone.
  void WriteCloud(const std::string& name) {
    Scan cloud;
    for (const Scan& scan : PileRecording().scans) {
      for (const Eigen::Vector3f& point : scan.points) {
        if (point.z() > 0.03f && point.cwiseAbs().maxCoeff() < 0.95f) cloud.points.push_back(point);
      }
    }
    ASSERT_EQ(WritePcd(files_.PathOf(name), cloud), "");
  }
  int Run(const std::function<void(ModelerOptions*)>& set) {
    ModelerOptions options;
    options.out = files_.PathOf("out.rimod");
    set(&options);
    return RunModeler(options, FewViews());
  }
  ModelFileResult Built() { return ReadModelFile(files_.PathOf("out.rimod")); }

  TemporaryFolder files_;
};

TEST_F(ModelerCommandTest, ARecordingBecomesAModel) {
  WriteRecording();
  ASSERT_EQ(Run([&](ModelerOptions* o) { o->recording = files_.path(); }), 0);
  const ModelFileResult built = Built();
  ASSERT_TRUE(built.model) << built.error;
  EXPECT_EQ(built.model->name, "pile");
  EXPECT_EQ(built.model->views.size(), 4u);
  EXPECT_GT(built.model->points.size(), 500u);
  EXPECT_EQ(built.model->box_max, Eigen::Vector3d(0.4, 0.4, 0.95));
}

TEST_F(ModelerCommandTest, EqualInputGivesEqualBytesWhateverTheThreads) {
  WriteRecording();
  std::vector<std::string> bytes;
  for (const int threads : {1, 3, 1}) {
    ASSERT_EQ(Run([&](ModelerOptions* o) {
                o->recording = files_.path();
                o->num_threads = threads;
              }),
              0);
    bytes.push_back(files_.Read("out.rimod"));
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  EXPECT_EQ(bytes[0], bytes[2]);
}

TEST_F(ModelerCommandTest, ACloudNeedsAClassFromOptionOrDescription) {
  WriteCloud("cloud.pcd");
  const auto cloud = [&](ModelerOptions* o) { o->cloud = files_.PathOf("cloud.pcd"); };
  EXPECT_EQ(Run(cloud), 2);
  EXPECT_FALSE(Built().model);
  files_.Write("model.json", "{\"class\": \"seat\"}");
  ASSERT_EQ(Run(cloud), 0);
  EXPECT_EQ(Built().model->name, "seat");
  EXPECT_EQ(Run([&](ModelerOptions* o) {
              cloud(o);
              o->class_name = "chair";
            }),
            0);
  EXPECT_EQ(Built().model->name, "chair");
  EXPECT_EQ(Run([&](ModelerOptions* o) {
              cloud(o);
              o->class_name = "../chair";
            }),
            2);
}

TEST_F(ModelerCommandTest, AMeshBecomesAModel) {
  files_.Write("wedge.obj",
               "v -0.3 -0.3 0\nv 0.3 -0.3 0\nv 0.3 0.3 0\nv -0.3 0.3 0\nv -0.3 -0.3 0.8\n"
               "v -0.3 0.3 0.8\nf 4 3 2 1\nf 1 2 5\nf 4 6 3\nf 1 5 6 4\nf 2 3 6 5\n");
  ASSERT_EQ(Run([&](ModelerOptions* o) {
              o->mesh = files_.PathOf("wedge.obj");
              o->class_name = "wedge";
            }),
            0);
  const ModelFileResult built = Built();
  ASSERT_TRUE(built.model) << built.error;
  EXPECT_EQ(built.model->name, "wedge");
  EXPECT_NEAR(built.model->box_max.z(), 0.8, 0.03);
}

TEST_F(ModelerCommandTest, UnusableInputLeavesTheOldModel) {
  files_.Write("out.rimod", "old");
  files_.Write("empty.ply", "");
  files_.Write("few.3d", "100 200 300\n100 201 300\n101 200 300\n");
  EXPECT_EQ(Run([&](ModelerOptions* o) { o->recording = files_.PathOf("none"); }), 1);
  EXPECT_EQ(Run([&](ModelerOptions* o) {
              o->cloud = files_.PathOf("empty.ply");
              o->class_name = "a";
            }),
            1);
  EXPECT_EQ(Run([&](ModelerOptions* o) {
              o->cloud = files_.PathOf("few.3d");
              o->class_name = "a";
            }),
            1);
  EXPECT_EQ(Run([&](ModelerOptions* o) {
              o->mesh = files_.PathOf("empty.ply");
              o->class_name = "a";
            }),
            1);
  EXPECT_EQ(files_.Read("out.rimod"), "old");
}

TEST_F(ModelerCommandTest, AModelIsDrawn) {
  WriteRecording();
  ASSERT_EQ(Run([&](ModelerOptions* o) { o->recording = files_.path(); }), 0);
  const std::string before = files_.Read("out.rimod");
  const auto inspect = [&](const std::string& model, const std::string& picture) {
    return Run([&](ModelerOptions* o) {
      o->inspect = files_.PathOf(model);
      o->output = files_.PathOf(picture);
    });
  };
  EXPECT_EQ(inspect("out.rimod", "sheet.png"), 0);
  EXPECT_EQ(files_.Read("sheet.png").substr(1, 3), "PNG");
  EXPECT_EQ(files_.Read("out.rimod"), before);
  EXPECT_EQ(inspect("missing.rimod", "other.png"), 1);
  EXPECT_EQ(files_.Read("other.png"), "");
  EXPECT_EQ(inspect("out.rimod", "no/sheet.png"), 1);
}

TEST_F(ModelerCommandTest, AModelThatCannotBeWrittenIsTold) {
  WriteCloud("cloud.pcd");
  EXPECT_EQ(Run([&](ModelerOptions* o) {
              o->cloud = files_.PathOf("cloud.pcd");
              o->class_name = "a";
              o->out = files_.PathOf("no/out.rimod");
            }),
            1);
}

}  // namespace
}  // namespace rimod
