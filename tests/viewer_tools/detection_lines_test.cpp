#include "viewer_tools/detection_lines.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

namespace rimod {
namespace {

constexpr char kGood[] =
    R"({"scan":"000","class":"fan","pose":[1,2,3,0,0,0,1],"score":0.83,"more":[]})";

TEST(DetectionLinesTest, ALineGivesScanClassPoseAndScore) {
  const ParsedDetectionLine parsed = ParseDetectionLine(kGood);
  ASSERT_TRUE(parsed.line) << parsed.error;
  EXPECT_EQ(parsed.line->scan, "000");
  EXPECT_EQ(parsed.line->detection.class_name, "fan");
  EXPECT_DOUBLE_EQ(parsed.line->detection.score, 0.83);
  const Eigen::Vector3d moved = parsed.line->detection.T_local_object * Eigen::Vector3d::UnitX();
  EXPECT_LT((moved - Eigen::Vector3d(0.0, 2.0, 3.0)).norm(), 1e-12);
}

TEST(DetectionLinesTest, BadLinesAreRefusedWithACause) {
  for (const char* text :
       {"", "{", "[]", "null", "{}", R"({"scan":1,"class":"fan","pose":[1,2,3,0,0,0,1],"score":1})",
        R"({"scan":"0","class":"../fan","pose":[1,2,3,0,0,0,1],"score":1})",
        R"({"scan":"0","class":"fan","pose":[1,2,3,0,0,1],"score":1})",
        R"({"scan":"0","class":"fan","pose":[1,2,3,0,0,0,2],"score":1})",
        R"({"scan":"0","class":"fan","pose":[1e999,2,3,0,0,0,1],"score":1})",
        R"({"scan":"0","class":"fan","pose":["1",2,3,0,0,0,1],"score":1})",
        R"({"scan":"0","class":"fan","pose":{},"score":1})",
        R"({"scan":"0","class":"fan","pose":[1,2,3,0,0,0,1],"score":"1"})",
        R"({"scan":"0","class":"fan","pose":[1,2,3,0,0,0,1]})"}) {
    const ParsedDetectionLine parsed = ParseDetectionLine(text);
    EXPECT_FALSE(parsed.line) << text;
    EXPECT_FALSE(parsed.error.empty()) << text;
  }
}

TEST(DetectionLinesTest, AFileKeepsItsGoodLinesAndNamesTheFirstBadOne) {
  const std::string path = testing::TempDir() + "detection_lines_test.jsonl";
  std::ofstream(path) << kGood << "\n\nnonsense\n" << kGood << "\n";
  const DetectionLines lines = ReadDetectionLines(path);
  EXPECT_EQ(lines.lines.size(), 2u);
  EXPECT_NE(lines.error.find(path + ": line 3"), std::string::npos) << lines.error;
  std::remove(path.c_str());
  const DetectionLines missing = ReadDetectionLines(path);
  EXPECT_TRUE(missing.lines.empty());
  EXPECT_NE(missing.error.find(path), std::string::npos);
}

}  // namespace
}  // namespace rimod
