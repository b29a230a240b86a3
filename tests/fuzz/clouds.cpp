// PCD, PLY and 3DTK files, recognised by their content.

#include "io/point_cloud_file.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const rimod::InputFile file("cloud");
  const rimod::PointCloudResult result = rimod::ReadPointCloud(file.Write(bytes, size));
  rimod::Require(result.scan.has_value() == result.error.empty(), "a scan or an error");
  if (!result.scan) return 0;
  rimod::Require(!result.scan->points.empty(), "a scan has points");
  rimod::Require(result.scan->T_local_sensor.matrix().allFinite(), "the sensor's pose is finite");
  for (const Eigen::Vector3f& point : result.scan->points)
    rimod::Require(point.allFinite(), "points are finite");
  return 0;
}
