#include "io/ply_header.h"

#include <optional>

namespace rimod {
namespace {

constexpr std::size_t kMaxElements = 100;
constexpr std::size_t kMaxProperties = 1000;  // of one element

using Words = std::vector<std::string_view>;

std::optional<NumberFormat> FormatFrom(std::string_view type) {
  using Kind = NumberFormat::Kind;
  if (type == "char" || type == "int8") return NumberFormat{Kind::kSigned, 1};
  if (type == "uchar" || type == "uint8") return NumberFormat{Kind::kUnsigned, 1};
  if (type == "short" || type == "int16") return NumberFormat{Kind::kSigned, 2};
  if (type == "ushort" || type == "uint16") return NumberFormat{Kind::kUnsigned, 2};
  if (type == "int" || type == "int32") return NumberFormat{Kind::kSigned, 4};
  if (type == "uint" || type == "uint32") return NumberFormat{Kind::kUnsigned, 4};
  if (type == "float" || type == "float32") return NumberFormat{Kind::kFloat, 4};
  if (type == "double" || type == "float64") return NumberFormat{Kind::kFloat, 8};
  return std::nullopt;
}

std::string SetEncoding(const Words& words, PlyHeader* header) {
  if (words.size() < 2) return "has a bad format line";
  if (words[1] == "ascii") {
    header->encoding = PlyEncoding::kAscii;
  } else if (words[1] == "binary_little_endian") {
    header->encoding = PlyEncoding::kLittleEndian;
  } else if (words[1] == "binary_big_endian") {
    header->encoding = PlyEncoding::kBigEndian;
  } else {
    return "has an unknown format '" + std::string(words[1].substr(0, 40)) + "'";
  }
  return "";
}

std::string AddElement(const Words& words, PlyHeader* header) {
  const std::optional<std::int64_t> count = words.size() == 3 ? ParseCount(words[2]) : std::nullopt;
  if (!count) return "has a bad element line";
  if (header->elements.size() >= kMaxElements) return "has too many elements";
  header->elements.push_back({std::string(words[1]), *count, {}});
  return "";
}

std::string AddProperty(const Words& words, PlyHeader* header) {
  if (header->elements.empty()) return "has a property outside of an element";
  std::vector<PlyProperty>& properties = header->elements.back().properties;
  if (properties.size() >= kMaxProperties) return "has too many properties";
  const bool is_list = words.size() == 5 && words[1] == "list";
  if (!is_list && words.size() != 3) return "has a bad property line";
  const std::optional<NumberFormat> format = FormatFrom(words[is_list ? 3 : 1]);
  const std::optional<NumberFormat> length = is_list ? FormatFrom(words[2]) : NumberFormat();
  if (!format || !length || (is_list && length->kind == NumberFormat::Kind::kFloat)) {
    return "has a property of unknown type: " + std::string(words.back().substr(0, 40));
  }
  properties.push_back({std::string(words.back()), *format, is_list, *length});
  return "";
}

}  // namespace

std::string ParsePlyHeader(const std::string& bytes, PlyHeader* header) {
  TextCursor cursor(bytes);
  bool has_format = false;
  cursor.NextLine();  // "ply"
  while (const std::optional<std::string_view> line = cursor.NextLine()) {
    const Words words = SplitWords(*line);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") {
      header->data_begin = cursor.position();
      return has_format ? "" : "has no format line";
    }
    std::string error = "has an unknown header line '" + std::string(words[0].substr(0, 40)) + "'";
    if (words[0] == "format") {
      has_format = true;
      error = SetEncoding(words, header);
    } else if (words[0] == "element") {
      error = AddElement(words, header);
    } else if (words[0] == "property") {
      error = AddProperty(words, header);
    }
    if (!error.empty()) return error;
  }
  return "is truncated: its header has no end";
}

}  // namespace rimod
