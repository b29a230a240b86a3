// compare_detections EXPECTED.jsonl FOUND.jsonl: whether both hold the same detections in the same
// order, within what another compiler or processor may change. Tells the first difference.
#include <cmath>
#include <cstdio>

#include "viewer_tools/detection_lines.h"

namespace {

constexpr double kMaxDistance = 1e-3;  // m
constexpr double kMaxAngle = 2e-3;     // rad
constexpr double kMaxScore = 0.01;

bool Differ(const rimod::Detection& a, const rimod::Detection& b) {
  const Eigen::Isometry3d T_a_b = a.T_local_object.inverse() * b.T_local_object;
  return a.class_name != b.class_name || T_a_b.translation().norm() > kMaxDistance ||
         Eigen::AngleAxisd(T_a_b.linear()).angle() > kMaxAngle ||
         std::abs(a.score - b.score) > kMaxScore;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const rimod::DetectionLines expected = rimod::ReadDetectionLines(argv[1]);
  const rimod::DetectionLines found = rimod::ReadDetectionLines(argv[2]);
  for (const std::string& error : {expected.error, found.error}) {
    if (error.empty()) continue;
    std::printf("%s\n", error.c_str());
    return 1;
  }
  if (expected.lines.size() != found.lines.size()) {
    std::printf("%zu detections, not %zu\n", found.lines.size(), expected.lines.size());
    return 1;
  }
  for (std::size_t i = 0; i < expected.lines.size(); ++i) {
    if (!Differ(expected.lines[i].detection, found.lines[i].detection)) continue;
    std::printf("detection %zu, %s, differs\n", i + 1,
                expected.lines[i].detection.class_name.c_str());
    return 1;
  }
  std::printf("%zu detections as expected\n", expected.lines.size());
}
