#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/numbers.h"

namespace rimod {

// One field of a PCD file's points.
struct PcdField {
  std::string name;
  NumberFormat format;
  std::int64_t count = 1;
  std::int64_t offset = 0;  // bytes from the start of the point's record
  std::int64_t column = 0;  // words from the start of the point's line
};

// The header of a PCD file, checked.
struct PcdHeader {
  std::vector<PcdField> fields;
  std::int64_t width = -1;  // -1: not given
  std::int64_t height = -1;
  std::int64_t points = -1;                                       // 1 .. kMaxPoints
  std::string encoding;                                           // of DATA
  std::size_t data_begin = 0;                                     // bytes from the file's start
  std::int64_t record_bytes = 0;                                  // of a point, binary
  std::int64_t num_columns = 0;                                   // of a point, ascii
  std::array<PcdField, 3> xyz;                                    // one value each
  Eigen::Isometry3d T_local_any = Eigen::Isometry3d::Identity();  // VIEWPOINT
  std::string warning;
};

// Reads the header that the bytes begin with. Returns an error text, empty when it is good.
std::string ParsePcdHeader(const std::string& bytes, PcdHeader* header);

}  // namespace rimod
