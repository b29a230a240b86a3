// compare_detections EXPECTED.jsonl FOUND.jsonl: whether both hold the same objects at the same
// places, in any order, with tolerances so that small changes of parameters need no new
// expectations. Tells the first difference.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "viewer_tools/detection_lines.h"

namespace {

constexpr double kMaxDistance = 0.02;  // m
constexpr double kMaxAngle = 0.035;    // rad
constexpr double kMaxScore = 0.2;

bool AreAlike(const rimod::DetectionLine& a, const rimod::DetectionLine& b) {
  const Eigen::Isometry3d T_a_b = a.detection.T_local_object.inverse() * b.detection.T_local_object;
  return a.scan == b.scan && a.detection.class_name == b.detection.class_name &&
         T_a_b.translation().norm() <= kMaxDistance &&
         Eigen::AngleAxisd(T_a_b.linear()).angle() <= kMaxAngle &&
         std::abs(a.detection.score - b.detection.score) <= kMaxScore;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const rimod::DetectionLines expected = rimod::ReadDetectionLines(argv[1]);
  rimod::DetectionLines found = rimod::ReadDetectionLines(argv[2]);
  for (const std::string& error : {expected.error, found.error}) {
    if (error.empty()) continue;
    std::printf("%s\n", error.c_str());
    return 1;
  }
  for (const rimod::DetectionLine& line : expected.lines) {
    const auto match =
        std::find_if(found.lines.begin(), found.lines.end(),
                     [&](const rimod::DetectionLine& other) { return AreAlike(line, other); });
    if (match == found.lines.end()) {
      std::printf("missing or elsewhere: %s\n", line.detection.class_name.c_str());
      return 1;
    }
    found.lines.erase(match);
  }
  for (const rimod::DetectionLine& line : found.lines)
    std::printf("not expected: %s\n", line.detection.class_name.c_str());
  if (found.lines.empty()) std::printf("%zu objects as expected\n", expected.lines.size());
  return found.lines.empty() ? 0 : 1;
}
