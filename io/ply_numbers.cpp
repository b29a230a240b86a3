#include "io/ply_numbers.h"

namespace rimod {

std::optional<double> PlyNumbers::Next(const NumberFormat& format) {
  if (encoding_ == PlyEncoding::kAscii) {
    const std::optional<std::string_view> word = text_.NextWord();
    return word ? ParseNumber(*word) : std::nullopt;
  }
  const auto size = static_cast<std::size_t>(format.size);
  if (data_.size() - position_ < size) return std::nullopt;
  const ByteOrder order =
      encoding_ == PlyEncoding::kLittleEndian ? ByteOrder::kLittle : ByteOrder::kBig;
  const double value = ReadNumber(data_.data() + position_, format, order);
  position_ += size;
  return value;
}

bool PlyNumbers::NextList(const PlyProperty& property, std::vector<double>* list) {
  const std::optional<double> length = Next(property.length_format);
  if (!length || !(*length >= 0.0)) return false;
  for (double i = 0.0; i < *length; ++i) {
    const std::optional<double> number = Next(property.format);
    if (!number) return false;
    if (list != nullptr) list->push_back(*number);
  }
  return true;
}

}  // namespace rimod
