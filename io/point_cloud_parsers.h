#pragma once

#include <string>

#include "io/point_cloud_file.h"

namespace rimod {

// The readers behind ReadPointCloud, one a format; bytes are the whole file, path names it in
// texts.
PointCloudResult ParsePcd(const std::string& bytes, const std::string& path);
PointCloudResult ParsePly(const std::string& bytes, const std::string& path);
PointCloudResult Parse3dtk(const std::string& bytes, const std::string& path);

// No file may declare more points: about 1.2 GB in memory.
constexpr std::int64_t kMaxPoints = 100'000'000;

// Takes a point (m, local frame) into the scan if it can be used, and counts it.
void AddPoint(double x, double y, double z, PointCloudResult* result);

// Ends reading: an error when nothing could be used, a warning when points were left out.
void FinishPointCloud(const std::string& path, PointCloudResult* result);

// The result of a file that cannot be used.
PointCloudResult BadPointCloud(const std::string& path, const std::string& cause);

}  // namespace rimod
