#include "io/point_cloud_file.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "io/files.h"
#include "io/numbers.h"
#include "io/point_cloud_parsers.h"
#include "io/pose_messages.h"

namespace rimod {
namespace {

constexpr std::int64_t kMaxFileBytes = std::int64_t{4} << 30;
constexpr std::int64_t kStartBytes = 4096;  // enough of a file to recognise it

bool StartsWith(const std::string& text, const char* start) { return text.rfind(start, 0) == 0; }

// True when the text's first lines, the very first perhaps left out, are three or more numbers
// each.
bool LooksLike3dtk(const std::string& start, bool whole) {
  TextCursor cursor(start);
  int num_points = 0;
  while (const std::optional<std::string_view> line = cursor.NextLine()) {
    if (!whole && cursor.position() >= start.size()) break;  // cut off
    const std::vector<std::string_view> words = SplitWords(*line);
    if (words.empty()) continue;
    bool is_point = words.size() >= 3;
    for (std::size_t i = 0; is_point && i < 3; ++i) is_point = ParseNumber(words[i]).has_value();
    if (!is_point && cursor.line_number() > 1) return false;
    num_points += is_point ? 1 : 0;
  }
  return num_points > 0;
}

PointCloudFormat RecogniseStart(const std::string& start, bool whole) {
  if (StartsWith(start, "ply\n") || StartsWith(start, "ply\r")) return PointCloudFormat::kPly;
  if (StartsWith(start, "# .PCD") || StartsWith(start, "VERSION ") ||
      StartsWith(start, "FIELDS ")) {
    return PointCloudFormat::kPcd;
  }
  if (start.find('\0') != std::string::npos) return PointCloudFormat::kUnknown;
  return LooksLike3dtk(start, whole) ? PointCloudFormat::k3dtk : PointCloudFormat::kUnknown;
}

std::string PcdHeader(const Scan& scan) {
  const std::array<double, 4> q = QuaternionOf(scan.T_local_sensor);
  const Eigen::Vector3d p = scan.T_local_sensor.translation();
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(),
                "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\n"
                "SIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH %zu\nHEIGHT 1\n"
                "VIEWPOINT %.17g %.17g %.17g %.17g %.17g %.17g %.17g\nPOINTS %zu\nDATA binary\n",
                scan.points.size(), p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3],
                scan.points.size());
  return text.data();
}

void AppendLittleEndian(float value, std::string* bytes) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  for (int i = 0; i < 4; ++i) bytes->push_back(static_cast<char>((bits >> (8 * i)) & 0xff));
}

}  // namespace

void AddPoint(double x, double y, double z, PointCloudResult* result) {
  // Farther away float keeps less than a metre and products overflow: no such point was measured.
  constexpr double kFarthest = 1e7;  // m
  const bool usable =
      std::abs(x) <= kFarthest && std::abs(y) <= kFarthest && std::abs(z) <= kFarthest;  // not NaN
  if (!usable) {
    ++result->counts.not_finite;
    return;
  }
  result->scan->points.emplace_back(static_cast<float>(x), static_cast<float>(y),
                                    static_cast<float>(z));
}

void FinishPointCloud(const std::string& path, PointCloudResult* result) {
  PointCloudCounts& counts = result->counts;
  counts.used = static_cast<std::int64_t>(result->scan->points.size());
  if (counts.used == 0) {
    const std::string cause =
        counts.declared == 0
            ? "holds no points"
            : "none of its " + std::to_string(counts.declared) + " points is usable";
    *result = BadPointCloud(path, cause);
    return;
  }
  if (counts.not_finite > 0) {
    if (!result->warning.empty()) result->warning += "; ";
    result->warning += path + ": left out " + std::to_string(counts.not_finite) + " of " +
                       std::to_string(counts.declared) + " points: not finite";
  }
}

PointCloudResult BadPointCloud(const std::string& path, const std::string& cause) {
  PointCloudResult result;
  result.error = path + ": " + cause;
  return result;
}

PointCloudFormat RecognisePointCloud(const std::string& path) {
  const std::string start = ReadFileStart(path, kStartBytes);
  return RecogniseStart(start, start.size() < kStartBytes);
}

PointCloudResult ReadPointCloud(const std::string& path) {
  FileBytes file = ReadFile(path, kMaxFileBytes);
  if (!file.bytes) {
    PointCloudResult result;
    result.error = file.error;
    return result;
  }
  const std::string& bytes = *file.bytes;
  if (bytes.empty()) return BadPointCloud(path, "is empty");
  const bool whole = bytes.size() <= kStartBytes;
  switch (RecogniseStart(bytes.substr(0, kStartBytes), whole)) {
    case PointCloudFormat::kPcd:
      return ParsePcd(bytes, path);
    case PointCloudFormat::kPly:
      return ParsePly(bytes, path);
    case PointCloudFormat::k3dtk:
      return Parse3dtk(bytes, path);
    case PointCloudFormat::kUnknown:
      break;
  }
  return BadPointCloud(path, "is neither a point cloud (PCD, PLY, 3DTK .3d) nor an LCM log");
}

std::string WritePcd(const std::string& path, const Scan& scan) {
  std::string bytes = PcdHeader(scan);
  bytes.reserve(bytes.size() + scan.points.size() * 12);
  for (const Eigen::Vector3f& point : scan.points) {
    for (int i = 0; i < 3; ++i) AppendLittleEndian(point[i], &bytes);
  }
  return WriteFileAtomically(path, bytes);
}

}  // namespace rimod
