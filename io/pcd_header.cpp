#include "io/pcd_header.h"

#include <algorithm>

#include "io/point_cloud_parsers.h"
#include "io/pose_messages.h"

namespace rimod {
namespace {

constexpr std::int64_t kMaxFields = 1000;
constexpr std::int64_t kMaxFieldCount = 100'000;  // values of one field, as descriptors have

// Sets the formats' sizes or kinds or the counts, one word a field. Returns an error text.
std::string SetFieldWords(const std::string& key, const std::vector<std::string_view>& words,
                          PcdHeader* header) {
  if (words.size() - 1 != header->fields.size()) return key + " does not fit FIELDS";
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    const std::string_view word = words[i + 1];
    PcdField& field = header->fields[i];
    if (key == "TYPE") {
      if (word != "F" && word != "I" && word != "U") return "unknown TYPE " + std::string(word);
      field.format.kind = word == "F"   ? NumberFormat::Kind::kFloat
                          : word == "I" ? NumberFormat::Kind::kSigned
                                        : NumberFormat::Kind::kUnsigned;
      continue;
    }
    const std::optional<std::int64_t> number = ParseCount(word);
    if (!number) return "bad " + key + " " + std::string(word);
    if (key == "SIZE") {
      if (*number != 1 && *number != 2 && *number != 4 && *number != 8) {
        return "bad SIZE " + std::string(word);
      }
      field.format.size = static_cast<int>(*number);
    } else {
      if (*number > kMaxFieldCount) return "bad COUNT " + std::string(word);
      field.count = *number;
    }
  }
  return "";
}

std::string SetViewpoint(const std::vector<std::string_view>& words, PcdHeader* header) {
  if (words.size() != 8) return "VIEWPOINT has not seven numbers";
  std::array<double, 7> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    const std::optional<double> number = ParseNumber(words[i + 1]);
    if (!number) return "bad VIEWPOINT " + std::string(words[i + 1]);
    v[i] = *number;
  }
  if (v[3] == 0.0 && v[4] == 0.0 && v[5] == 0.0 && v[6] == 0.0) {
    header->warning = "VIEWPOINT has no direction, taken as looking along x";
    v[3] = 1.0;
  }
  const std::optional<Eigen::Isometry3d> T_local_any = PoseFrom(v.data(), v.data() + 3);
  if (!T_local_any) return "VIEWPOINT is not a pose";
  header->T_local_any = *T_local_any;
  return "";
}

std::string SetCount(const std::vector<std::string_view>& words, std::int64_t* count) {
  const std::string key(words[0]);
  const std::optional<std::int64_t> number =
      words.size() == 2 ? ParseCount(words[1]) : std::nullopt;
  if (!number) return "bad " + key;
  *count = *number;
  return "";
}

// Takes one line of the header in. Returns an error text.
std::string TakeLine(const std::vector<std::string_view>& words, PcdHeader* header) {
  const std::string key(words[0]);
  if (key == "FIELDS" || key == "COLUMNS") {
    if (words.size() > kMaxFields) return "has too many FIELDS";
    header->fields.assign(words.size() - 1, PcdField());
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
      header->fields[i].name = std::string(words[i + 1]);
    }
    return "";
  }
  if (key == "SIZE" || key == "TYPE" || key == "COUNT") return SetFieldWords(key, words, header);
  if (key == "WIDTH") return SetCount(words, &header->width);
  if (key == "HEIGHT") return SetCount(words, &header->height);
  if (key == "POINTS") return SetCount(words, &header->points);
  if (key == "VIEWPOINT") return SetViewpoint(words, header);
  if (key == "VERSION") return "";
  return "unknown header line '" + key.substr(0, 40) + "'";
}

// Checks the counts against each other and settles header->points. Returns an error text.
std::string SettlePoints(PcdHeader* header) {
  const std::int64_t height = std::max<std::int64_t>(header->height, header->height < 0 ? 1 : 0);
  if (header->width >= 0) {
    if (header->width > kMaxPoints || height > kMaxPoints || header->width * height > kMaxPoints) {
      return "declares more than " + std::to_string(kMaxPoints) + " points";
    }
    const std::int64_t product = header->width * height;
    if (header->points >= 0 && header->points != product) {
      return "counts differ: POINTS " + std::to_string(header->points) + ", but WIDTH x HEIGHT " +
             std::to_string(product);
    }
    header->points = product;
  }
  if (header->points < 0) return "has neither WIDTH nor POINTS";
  if (header->points > kMaxPoints) {
    return "declares more than " + std::to_string(kMaxPoints) + " points";
  }
  return header->points == 0 ? "holds no points" : "";
}

// Lays the fields out and finds x, y, z. Returns an error text.
std::string SettleFields(PcdHeader* header) {
  for (PcdField& field : header->fields) {
    if (field.format.kind == NumberFormat::Kind::kFloat && field.format.size < 4) {
      return "field " + field.name.substr(0, 40) + " is a float of " +
             std::to_string(field.format.size) + " bytes";
    }
    field.offset = header->record_bytes;
    field.column = header->num_columns;
    header->record_bytes += field.format.size * field.count;
    header->num_columns += field.count;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const auto field = std::find_if(header->fields.begin(), header->fields.end(),
                                    [&](const PcdField& f) { return f.name == name; });
    if (field == header->fields.end() || field->count != 1) return "has no field " + name;
    header->xyz[axis] = *field;
  }
  return "";
}

}  // namespace

std::string ParsePcdHeader(const std::string& bytes, PcdHeader* header) {
  TextCursor cursor(bytes);
  while (const std::optional<std::string_view> line = cursor.NextLine()) {
    const std::vector<std::string_view> words = SplitWords(*line);
    if (words.empty() || words[0].front() == '#') continue;
    if (words[0] == "DATA") {
      header->encoding = words.size() == 2 ? std::string(words[1]) : "";
      header->data_begin = cursor.position();
      const std::string error = SettlePoints(header);
      return error.empty() ? SettleFields(header) : error;
    }
    const std::string error = TakeLine(words, header);
    if (!error.empty()) return error;
  }
  return "is truncated: its header has no DATA line";
}

}  // namespace rimod
