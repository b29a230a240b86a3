#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/numbers.h"

namespace rimod {

// One property of a PLY element: a number, or a list that begins with its length.
struct PlyProperty {
  std::string name;
  NumberFormat format;  // of the number or of the list's numbers
  bool is_list = false;
  NumberFormat length_format;
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };

// The header of a PLY file.
struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;  // in the order of the file
  std::size_t data_begin = 0;        // bytes from the file's start
};

// Reads the header that the bytes begin with. Returns an error text, empty when it is good.
std::string ParsePlyHeader(const std::string& bytes, PlyHeader* header);

}  // namespace rimod
