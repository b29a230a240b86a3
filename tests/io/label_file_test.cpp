#include "io/label_file.h"

#include <gtest/gtest.h>

namespace rimod {
namespace {

std::string OneObject(const std::string& fields) {
  return R"({"scans": [{"scan": "000", "objects": [{)" + fields + "}]}]}";
}

TEST(LabelFileTest, ReadsWhatTheLabelsSay) {
  const LabelFile labels = ParseLabels(
      OneObject(R"("class": "fan", "pose": [1, 2, 3, 0, 0, 0, 1], "points": 77, "visible": 0.5,
                   "distance": 4.5, "comment": "turned")"),
      "x");
  ASSERT_EQ(labels.error, "");
  ASSERT_EQ(labels.scans.size(), 1u);
  EXPECT_EQ(labels.scans[0].scan, "000");
  const LabelledObject& object = labels.scans[0].objects.at(0);
  EXPECT_EQ(object.class_name, "fan");
  EXPECT_EQ(object.num_points, 77);
  EXPECT_EQ(object.visible, 0.5);
  EXPECT_EQ(object.distance, 4.5);
  EXPECT_TRUE(object.T_local_object.translation().isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_TRUE(object.T_local_object.linear().col(0).isApprox(-Eigen::Vector3d::UnitX()));
}

TEST(LabelFileTest, WithoutPointsAndVisibilityAnObjectCounts) {
  const LabelFile labels =
      ParseLabels(OneObject(R"("class": "fan", "pose": [3, 4, 0, 1, 0, 0, 0])"), "x");
  ASSERT_EQ(labels.error, "");
  const LabelledObject& object = labels.scans[0].objects.at(0);
  EXPECT_EQ(object.visible, 1.0);
  EXPECT_GT(object.num_points, 1'000'000);
  EXPECT_DOUBLE_EQ(object.distance, 5.0);
}

TEST(LabelFileTest, EverythingElseIsRefusedWithItsCause) {
  const auto error = [](const std::string& text) { return ParseLabels(text, "name").error; };
  for (const std::string text :
       {"", "[]", "{}", R"({"scans": 3})", R"({"scans": [1]})", R"({"scans": [{"scan": 1}]})",
        R"({"scans": [{"scan": "0"}]})", R"({"scans": [{"scan": "0", "objects": [7]}]})"})
    EXPECT_NE(error(text).find("name: "), std::string::npos) << text;
  const std::string pose = R"("pose": [0, 0, 0, 1, 0, 0, 0])";
  EXPECT_NE(error(OneObject(pose)).find("class"), std::string::npos);
  EXPECT_NE(error(OneObject(R"("class": "../x", )" + pose)).find("class"), std::string::npos);
  const std::string fan = R"("class": "fan", )";
  EXPECT_NE(error(OneObject(fan + R"("pose": [0, 0, 0])")).find("pose"), std::string::npos);
  EXPECT_NE(error(OneObject(fan + R"("pose": [0, 0, 0, 0, 0, 0, 0])")).find("pose"),
            std::string::npos);
  EXPECT_NE(error(OneObject(fan + pose + R"(, "points": -5)")).find("points"), std::string::npos);
  EXPECT_NE(error(OneObject(fan + pose + R"(, "points": "many")")).find("points"),
            std::string::npos);
  EXPECT_NE(error(OneObject(fan + pose + R"(, "visible": 7)")).find("visible"), std::string::npos);
  EXPECT_NE(error(OneObject(fan + pose + R"(, "distance": -1)")).find("distance"),
            std::string::npos);
}

TEST(LabelFileTest, MissingFileIsNamed) {
  EXPECT_NE(ReadLabelFile("/nowhere/labels.json").error.find("/nowhere/labels.json"),
            std::string::npos);
  EXPECT_FALSE(ReadSymmetry("/nowhere").has_value());
}

}  // namespace
}  // namespace rimod
