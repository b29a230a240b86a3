#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "io/numbers.h"
#include "io/ply_header.h"

namespace rimod {

// Reads the numbers after a PLY file's header one after the other, text or binary alike.
class PlyNumbers {
 public:
  PlyNumbers(PlyEncoding encoding, std::string_view data)
      : encoding_(encoding), data_(data), text_(data) {}

  // The next number; nothing at the end or where there is something else.
  std::optional<double> Next(const NumberFormat& format);

  // The next list, its numbers appended to `list` unless that is null. False when there is no whole
  // list. Nothing is allocated for numbers that are not there.
  bool NextList(const PlyProperty& property, std::vector<double>* list);

 private:
  PlyEncoding encoding_;
  std::string_view data_;
  std::size_t position_ = 0;  // binary
  TextCursor text_;
};

}  // namespace rimod
