#include "io/cloud_messages.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace rimod {
namespace {

constexpr std::int8_t kFloat32 = 7;  // as in the ROS message
constexpr std::int8_t kFloat64 = 8;

bool MachineIsBigEndian() {
  const std::uint16_t one = 1;
  std::uint8_t first = 0;
  std::memcpy(&first, &one, 1);
  return first == 0;
}

// Where one coordinate stands in a point's record.
struct Column {
  std::int64_t offset = 0;  // bytes
  bool is_double = false;
};

struct ColumnResult {
  std::optional<Column> column;
  std::string error;
};

ColumnResult FindColumn(const bot_core::pointcloud2_t& message, const std::string& name) {
  const auto is_named = [&name](const bot_core::pointfield_t& field) { return field.name == name; };
  const auto count = std::count_if(message.fields.begin(), message.fields.end(), is_named);
  if (count != 1) {
    return {std::nullopt, count == 0 ? "has no field " + name : "has more than one field " + name};
  }
  const bot_core::pointfield_t& field =
      *std::find_if(message.fields.begin(), message.fields.end(), is_named);
  if (field.datatype != kFloat32 && field.datatype != kFloat64) {
    return {std::nullopt, "field " + name + " is neither FLOAT32 (7) nor FLOAT64 (8)"};
  }
  // Old drivers leave the count at 0 for a single value.
  if (field.count != 1 && field.count != 0) return {std::nullopt, "field " + name + " is a list"};
  const Column column = {field.offset, field.datatype == kFloat64};
  const std::int64_t end = column.offset + (column.is_double ? 8 : 4);
  if (column.offset < 0 || end > message.point_step) {
    return {std::nullopt, "field " + name + " is not within point_step"};
  }
  return {column, ""};
}

std::string CheckCounts(const bot_core::pointcloud2_t& message) {
  if (message.height < 0 || message.width < 0 || message.nfields < 0 || message.data_nbytes < 0 ||
      message.fields.size() != static_cast<std::size_t>(message.nfields) ||
      message.data.size() != static_cast<std::size_t>(message.data_nbytes)) {
    return "a count does not fit its list";
  }
  if (message.point_step <= 0) return "point_step is not positive";
  if (message.height == 0 || message.width == 0) return "";
  const std::int64_t row_bytes = std::int64_t{message.width} * message.point_step;
  // Unordered clouds of some drivers leave the row's step at 0.
  if (message.row_step < row_bytes && !(message.height == 1 && message.row_step == 0)) {
    return "row_step is shorter than a row";
  }
  const std::int64_t rows_before_last = message.height - 1;
  if (rows_before_last > 0 &&
      message.row_step > (message.data_nbytes - row_bytes) / rows_before_last)
    return "has fewer bytes than its rows";
  return row_bytes <= message.data_nbytes ? "" : "has fewer bytes than its rows";
}

// One value, its bytes turned where the cloud's order is not the machine's.
float ReadValue(const std::uint8_t* bytes, bool is_double, bool turned) {
  std::array<std::uint8_t, 8> value{};
  const std::size_t size = is_double ? 8 : 4;
  std::memcpy(value.data(), bytes, size);
  if (turned) std::reverse(value.begin(), value.begin() + size);
  if (is_double) {
    double number = 0.0;
    std::memcpy(&number, value.data(), sizeof number);
    return static_cast<float>(number);
  }
  float number = 0.0f;
  std::memcpy(&number, value.data(), sizeof number);
  return number;
}

}  // namespace

SensorCloudFromMessage FromMessage(const bot_core::pointcloud2_t& message) {
  std::string error = CheckCounts(message);
  if (!error.empty()) return {std::nullopt, std::move(error)};
  std::array<Column, 3> columns;
  const std::array<std::string, 3> names = {"x", "y", "z"};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    ColumnResult found = FindColumn(message, names[i]);
    if (!found.column) return {std::nullopt, std::move(found.error)};
    columns[i] = *found.column;
  }
  const bool turned = (message.is_bigendian != 0) != MachineIsBigEndian();
  SensorCloud cloud;
  cloud.time = Time(message.utime);
  // Both counts are covered by bytes that are there: the product is bounded by those.
  cloud.points.reserve(static_cast<std::size_t>(message.height) *
                       static_cast<std::size_t>(message.width));
  const std::int64_t num_rows = message.width > 0 ? message.height : 0;  // empty rows have no bytes
  for (std::int64_t row = 0; row < num_rows; ++row) {
    for (std::int64_t column = 0; column < message.width; ++column) {
      const std::uint8_t* const record =
          message.data.data() + row * message.row_step + column * message.point_step;
      Eigen::Vector3f point;
      for (int i = 0; i < 3; ++i) {
        const Column& place = columns[static_cast<std::size_t>(i)];
        point[i] = ReadValue(record + place.offset, place.is_double, turned);
      }
      if (point.allFinite() && !point.isZero(0.0f)) cloud.points.push_back(point);
    }
  }
  return {std::move(cloud), ""};
}

bot_core::pointcloud2_t ToMessage(const SensorCloud& cloud, const std::string& frame_id) {
  bot_core::pointcloud2_t message = {};
  message.utime = cloud.time.count();
  message.frame_id = frame_id;
  message.height = 1;
  message.width = static_cast<std::int32_t>(cloud.points.size());
  constexpr std::int32_t kValueBytes = 4;
  for (const char* const name : {"x", "y", "z"}) {
    bot_core::pointfield_t field = {};
    field.name = name;
    field.offset = kValueBytes * static_cast<std::int32_t>(message.fields.size());
    field.datatype = kFloat32;
    field.count = 1;
    message.fields.push_back(field);
  }
  message.nfields = static_cast<std::int32_t>(message.fields.size());
  message.is_bigendian = MachineIsBigEndian() ? 1 : 0;
  message.point_step = 3 * kValueBytes;
  message.row_step = message.point_step * message.width;
  message.data.resize(static_cast<std::size_t>(message.row_step));
  if (!cloud.points.empty())
    std::memcpy(message.data.data(), cloud.points.data(), message.data.size());
  message.data_nbytes = static_cast<std::int32_t>(message.data.size());
  message.is_dense = 1;
  return message;
}

}  // namespace rimod
