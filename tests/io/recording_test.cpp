#include "io/recording.h"

#include <gtest/gtest.h>

#include "io/point_cloud_file.h"
#include "tests/io/random_values.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_matchers.h"

namespace rimod {
namespace {

constexpr char kDescription[] =
    R"({"class": "fan", "object_pose": [1, 2, 0.5, 0, 0, 0, 1], "symmetry": "none",
        "box": {"min": [-0.2, -0.3, 0], "max": [0.2, 0.3, 0.6]}})";

TEST(RecordingTest, DescriptionAndScansAreRead) {
  const TemporaryFolder folder;
  folder.Write("model.json", kDescription);
  RandomValues random(1);
  std::vector<Scan> scans;
  for (const char* name : {"scan_001.pcd", "scan_000.pcd", "other.pcd"}) {
    scans.push_back(random.AScan(20, 0));
    ASSERT_EQ(WritePcd(folder.PathOf(name), scans.back()), "");
  }
  const RecordingResult read = ReadRecording(folder.path());
  ASSERT_TRUE(read.recording) << read.error;
  EXPECT_TRUE(read.warnings.empty());
  EXPECT_EQ(read.recording->class_name, "fan");
  EXPECT_EQ(read.recording->T_local_object * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 2, 0.5));
  EXPECT_EQ(read.recording->box_min, Eigen::Vector3d(-0.2, -0.3, 0.0));
  EXPECT_EQ(read.recording->box_max, Eigen::Vector3d(0.2, 0.3, 0.6));
  ASSERT_EQ(read.recording->scans.size(), 2u);
  EXPECT_EQ(read.recording->scans[0].points, scans[1].points);
  EXPECT_EQ(read.recording->scans[1].points, scans[0].points);
  EXPECT_TRUE(
      PosesNear(read.recording->scans[0].T_local_sensor, scans[1].T_local_sensor, 1e-9, 1e-6));
  EXPECT_EQ(ReadClassName(folder.path()), "fan");
}

TEST(RecordingTest, BadScansAreLeftOutUnlessNoneIsGood) {
  const TemporaryFolder folder;
  folder.Write("model.json", kDescription);
  folder.Write("scan_000.pcd", "VERSION 0.7\nFIELDS x y z\n");
  const RecordingResult none = ReadRecording(folder.path());
  EXPECT_FALSE(none.recording);
  EXPECT_TRUE(Mentions(none.error, {folder.path(), "scan_*.pcd"}));
  ASSERT_EQ(WritePcd(folder.PathOf("scan_001.pcd"), RandomValues(2).AScan(5, 0)), "");
  const RecordingResult one = ReadRecording(folder.path());
  ASSERT_TRUE(one.recording) << one.error;
  EXPECT_EQ(one.recording->scans.size(), 1u);
  ASSERT_EQ(one.warnings.size(), 1u);
  EXPECT_TRUE(Mentions(one.warnings[0], {"scan_000.pcd", "truncated"}));
}

TEST(RecordingTest, BadDescriptionsAreErrors) {
  const TemporaryFolder folder;
  ASSERT_EQ(WritePcd(folder.PathOf("scan_000.pcd"), RandomValues(3).AScan(5, 0)), "");
  EXPECT_TRUE(Mentions(ReadRecording(folder.path()).error, {"model.json"}));
  const auto error_of = [&folder](const std::string& json) {
    folder.Write("model.json", json);
    const RecordingResult read = ReadRecording(folder.path());
    EXPECT_FALSE(read.recording) << json;
    return read.error;
  };
  const auto replaced = [&error_of](const std::string& what, const std::string& by) {
    std::string json = kDescription;
    json.replace(json.find(what), what.size(), by);
    return error_of(json);
  };
  EXPECT_TRUE(Mentions(error_of(""), {"model.json", "not JSON"}));
  EXPECT_TRUE(Mentions(error_of("[1, 2"), {"not JSON"}));
  EXPECT_TRUE(Mentions(error_of("[]"), {"class"}));
  EXPECT_TRUE(Mentions(error_of("null"), {"class"}));
  EXPECT_TRUE(Mentions(replaced("\"fan\"", "5"), {"class"}));
  EXPECT_TRUE(Mentions(replaced("\"fan\"", "\"../fan\""), {"class"}));
  EXPECT_TRUE(Mentions(replaced("0, 0, 0, 1]", "0, 0, 0]"), {"object_pose"}));
  EXPECT_TRUE(Mentions(replaced("0, 0, 0, 1]", "0, 0, 0, 0]"), {"object_pose"}));
  EXPECT_TRUE(Mentions(replaced("0, 0, 0, 1]", "0, 0, 0, \"1\"]"), {"object_pose"}));
  EXPECT_TRUE(Mentions(replaced("0, 0, 0, 1]", "0, 0, 0, 1e999]"), {"model.json"}));
  EXPECT_TRUE(Mentions(replaced("\"max\"", "\"mux\""), {"box"}));
  EXPECT_TRUE(Mentions(replaced("[0.2, 0.3, 0.6]", "[0.2, -0.4, 0.6]"), {"box"}));
  EXPECT_TRUE(Mentions(replaced("[0.2, 0.3, 0.6]", "[0.2, 1e300, 0.6]"), {"box"}));
  EXPECT_TRUE(Mentions(error_of(std::string(100'000, '[')), {"not JSON"}));
  EXPECT_EQ(ReadClassName(folder.path()), std::nullopt);
}

}  // namespace
}  // namespace rimod
