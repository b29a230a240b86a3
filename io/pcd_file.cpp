#include <lzf.h>

#include "io/pcd_header.h"
#include "io/point_cloud_parsers.h"

namespace rimod {
namespace {

std::string Truncated(const PcdHeader& header, std::size_t there) {
  return "is truncated: declares " + std::to_string(header.points) + " points (" +
         std::to_string(header.points * header.record_bytes) + " bytes), but holds " +
         std::to_string(there) + " bytes of them";
}

std::string ReadAscii(const PcdHeader& header, std::string_view text, PointCloudResult* result) {
  TextCursor cursor(text);
  std::int64_t num_points = 0;
  while (num_points < header.points) {
    const std::optional<std::string_view> line = cursor.NextLine();
    if (!line) {
      return "is truncated: declares " + std::to_string(header.points) + " points, but holds " +
             std::to_string(num_points);
    }
    const std::vector<std::string_view> words = SplitWords(*line);
    if (words.empty()) continue;
    const std::string place = "in line " + std::to_string(cursor.line_number()) + " of the points";
    if (static_cast<std::int64_t>(words.size()) != header.num_columns) {
      return "has " + std::to_string(words.size()) + " instead of " +
             std::to_string(header.num_columns) + " numbers " + place;
    }
    double point[3] = {0.0, 0.0, 0.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<double> number =
          ParseNumber(words[static_cast<std::size_t>(header.xyz[axis].column)]);
      if (!number) return "has something that is no number " + place;
      point[axis] = *number;
    }
    AddPoint(point[0], point[1], point[2], result);
    ++num_points;
  }
  if (cursor.NextWord()) result->warning = "holds more points than it declares, which are left out";
  return "";
}

std::string ReadBinary(const PcdHeader& header, std::string_view records,
                       PointCloudResult* result) {
  const std::int64_t need = header.points * header.record_bytes;
  if (need > static_cast<std::int64_t>(records.size())) return Truncated(header, records.size());
  result->scan->points.reserve(static_cast<std::size_t>(header.points));
  for (const char* record = records.data(); record < records.data() + need;
       record += header.record_bytes) {
    double point[3] = {0.0, 0.0, 0.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const PcdField& field = header.xyz[axis];
      point[axis] = ReadNumber(record + field.offset, field.format, ByteOrder::kLittle);
    }
    AddPoint(point[0], point[1], point[2], result);
  }
  if (need < static_cast<std::int64_t>(records.size())) {
    result->warning = "holds more bytes than it declares points, which are left out";
  }
  return "";
}

// The points' values, all of the first field, then all of the second, .. Returns an error text.
std::string Decompress(const PcdHeader& header, std::string_view block, std::string* columns) {
  constexpr std::size_t kSizes = 8;
  if (block.size() < kSizes) return Truncated(header, 0);
  const NumberFormat format{NumberFormat::Kind::kUnsigned, 4};
  const auto packed =
      static_cast<std::int64_t>(ReadNumber(block.data(), format, ByteOrder::kLittle));
  const auto unpacked =
      static_cast<std::int64_t>(ReadNumber(block.data() + 4, format, ByteOrder::kLittle));
  const auto there = static_cast<std::int64_t>(block.size() - kSizes);
  if (packed > there) {
    return "is truncated: declares " + std::to_string(packed) + " compressed bytes, but holds " +
           std::to_string(there);
  }
  if (unpacked != header.points * header.record_bytes) {
    return "counts differ: its points take " + std::to_string(header.points * header.record_bytes) +
           " bytes, but " + std::to_string(unpacked) + " are declared";
  }
  constexpr std::int64_t kBestRatio = 132;  // LZF: at most 264 bytes from 2
  if (unpacked / kBestRatio > packed) return "has compressed points that cannot be that many";
  columns->resize(static_cast<std::size_t>(unpacked));
  const unsigned int done = lzf_decompress(block.data() + kSizes, static_cast<unsigned int>(packed),
                                           columns->data(), static_cast<unsigned int>(unpacked));
  return done == unpacked ? "" : "has compressed points that are damaged";
}

std::string ReadCompressed(const PcdHeader& header, std::string_view block,
                           PointCloudResult* result) {
  std::string columns;
  const std::string error = Decompress(header, block, &columns);
  if (!error.empty()) return error;
  result->scan->points.reserve(static_cast<std::size_t>(header.points));
  for (std::int64_t i = 0; i < header.points; ++i) {
    double point[3] = {0.0, 0.0, 0.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const PcdField& field = header.xyz[axis];
      const std::int64_t at = field.offset * header.points + i * field.format.size;
      point[axis] = ReadNumber(columns.data() + at, field.format, ByteOrder::kLittle);
    }
    AddPoint(point[0], point[1], point[2], result);
  }
  return "";
}

}  // namespace

PointCloudResult ParsePcd(const std::string& bytes, const std::string& path) {
  PcdHeader header;
  std::string error = ParsePcdHeader(bytes, &header);
  if (!error.empty()) return BadPointCloud(path, error);

  PointCloudResult result;
  result.counts.declared = header.points;
  result.scan.emplace();
  result.scan->T_local_sensor = LevelPose(header.T_local_any);
  const std::string_view points = std::string_view(bytes).substr(header.data_begin);
  if (header.encoding == "ascii") {
    error = ReadAscii(header, points, &result);
  } else if (header.encoding == "binary") {
    error = ReadBinary(header, points, &result);
  } else if (header.encoding == "binary_compressed") {
    error = ReadCompressed(header, points, &result);
  } else {
    error = "has an unknown DATA encoding '" + header.encoding.substr(0, 40) + "'";
  }
  if (!error.empty()) return BadPointCloud(path, error);
  if (result.warning.empty()) result.warning = header.warning;
  if (!result.warning.empty()) result.warning = path + ": " + result.warning;
  FinishPointCloud(path, &result);
  return result;
}

}  // namespace rimod
