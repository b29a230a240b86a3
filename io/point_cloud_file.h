#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "rimod/scan.h"

namespace rimod {

// What was found in a point cloud file, by use.
struct PointCloudCounts {
  std::int64_t declared = 0;    // points that the file says it holds
  std::int64_t used = 0;        // in the scan
  std::int64_t not_finite = 0;  // left out: NaN or infinite
  std::int64_t no_return = 0;   // beams without a return (3DTK)
  std::int64_t near = 0;        // left out: on the robot itself (3DTK)
};

// A point cloud read from a file: the scan, or why there is none.
struct PointCloudResult {
  std::optional<Scan> scan;
  std::string error;    // names the file and the cause; empty when there is a scan
  std::string warning;  // worth telling although there is a scan; names the file; mostly empty
  PointCloudCounts counts;
};

enum class PointCloudFormat { kUnknown, kPcd, kPly, k3dtk };

// What a file's content looks like; kUnknown also when it cannot be read.
PointCloudFormat RecognisePointCloud(const std::string& path);

// Reads a point cloud of any of these formats, recognised by its content. Metres; the scan's local
// frame is the file's frame.
// PCD: ascii, binary, binary_compressed; VIEWPOINT is the sensor's pose in the points' frame, made
// level.
// PLY: ascii, binary of either byte order; a `camera` element as PCL writes it gives the sensor's
// position, else it is the origin; its heading is along x.
// 3DTK .3d: centimetres, left-handed (x right, y up, z forward), turned into the sensor frame (x
// forward, y left, z up); readings of about 3276 cm are beams without a return, readings below 20
// cm hit the scanner's carrier; both are counted. A .pose file beside it is not used: the sensor is
// the origin. Nothing is allocated for points that the file does not hold.
PointCloudResult ReadPointCloud(const std::string& path);

// Writes the scan's points (local frame) as binary PCD, VIEWPOINT = T_local_sensor. Beams without a
// return are not kept. Returns an error text, empty when done; never leaves half a file.
std::string WritePcd(const std::string& path, const Scan& scan);

}  // namespace rimod
