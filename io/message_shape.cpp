#include "io/message_shape.h"

#include <cstring>

#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/pointcloud2_t.hpp"
#include "bot_core/rigid_transform_t.hpp"
#include "rimod/detections_t.hpp"
#include "rimod/early_detections_t.hpp"
#include "rimod/feature_set_t.hpp"
#include "rimod/object_model_t.hpp"
#include "rimod/partial_feature_set_t.hpp"
#include "rimod/partial_range_image_t.hpp"
#include "rimod/partial_scan_t.hpp"
#include "rimod/pose_hypotheses_t.hpp"
#include "rimod/range_image_t.hpp"
#include "rimod/scan_end_t.hpp"
#include "rimod/scan_t.hpp"
#include "rimod/shard_candidates_t.hpp"
#include "rimod/shard_scan_t.hpp"
#include "rimod/shard_t.hpp"
#include "rimod/shard_turn_t.hpp"
#include "rimod/status_t.hpp"

namespace rimod {
namespace {

constexpr std::size_t kByte = 1;
constexpr std::size_t kInt16 = 2;
constexpr std::size_t kInt32 = 4;
constexpr std::size_t kInt64 = 8;
constexpr std::size_t kFloat = 4;
constexpr std::size_t kDouble = 8;
constexpr std::size_t kPose = 7 * kDouble;  // position and quaternion
constexpr std::size_t kBox = 6 * kDouble;

// Big-endian, as LCM encodes.
std::uint64_t ReadBigEndian(const std::uint8_t* bytes, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[i];
  return value;
}

void SkipArrays(ShapeCursor* cursor, int num_arrays, std::int32_t count, std::size_t bytes) {
  for (int i = 0; i < num_arrays; ++i) cursor->SkipArray(count, bytes);
}

void SkipDetection(ShapeCursor* cursor) {
  cursor->SkipString();
  cursor->Skip(kPose + kBox + kDouble);
}

void SkipStageTimes(ShapeCursor* cursor) {
  const std::int32_t count = cursor->Count();
  for (std::int32_t i = 0; i < count && cursor->ok(); ++i) {
    cursor->SkipString();
    cursor->Skip(kDouble);
  }
}

}  // namespace

void ShapeCursor::Fail(const char* error) {
  if (error_ == nullptr) error_ = error;
}

void ShapeCursor::Skip(std::size_t num_bytes) {
  if (!ok()) return;
  if (num_bytes > size_ - position_) return Fail("is cut off");
  position_ += num_bytes;
}

std::int32_t ShapeCursor::Count() {
  if (!ok()) return 0;
  if (kInt32 > size_ - position_) {
    Fail("is cut off");
    return 0;
  }
  const auto count = static_cast<std::int32_t>(ReadBigEndian(bytes_ + position_, kInt32));
  position_ += kInt32;
  if (count < 0) {
    Fail("has a negative count");
    return 0;
  }
  return count;
}

void ShapeCursor::SkipArray(std::int32_t count, std::size_t element_bytes) {
  if (!ok()) return;
  if (static_cast<std::size_t>(count) > (size_ - position_) / element_bytes) {
    return Fail("has a count that is larger than its bytes");
  }
  position_ += static_cast<std::size_t>(count) * element_bytes;
}

void ShapeCursor::SkipString() {
  const std::int32_t length = Count();
  const std::size_t begin = position_;
  SkipArray(length, kByte);
  if (!ok()) return;
  const void* const zero =
      length == 0 ? nullptr : std::memchr(bytes_ + begin, 0, static_cast<std::size_t>(length));
  if (zero != bytes_ + position_ - 1) Fail("has a text that does not end where it should");
}

template <>
void WalkShape<bot_core::planar_lidar_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64);
  cursor->SkipArray(cursor->Count(), kFloat);
  cursor->SkipArray(cursor->Count(), kFloat);
  cursor->Skip(2 * kFloat);
}

template <>
void WalkShape<bot_core::rigid_transform_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64 + kPose);
}

template <>
void WalkShape<bot_core::pointcloud2_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64 + kInt32);
  cursor->SkipString();
  cursor->Skip(2 * kInt32);
  const std::int32_t num_fields = cursor->Count();
  for (std::int32_t i = 0; i < num_fields && cursor->ok(); ++i) {
    cursor->SkipString();
    cursor->Skip(kInt32 + kByte + kInt32);
  }
  cursor->Skip(kByte + 2 * kInt32);
  cursor->SkipArray(cursor->Count(), kByte);
  cursor->Skip(kByte);
}

template <>
void WalkShape<scan_t>(ShapeCursor* cursor) {
  cursor->Skip(2 * kInt64 + 4 * kInt32 + kPose);
  SkipArrays(cursor, 3, cursor->Count(), kFloat);
  SkipArrays(cursor, 3, cursor->Count(), kFloat);
}

template <>
void WalkShape<range_image_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64 + 2 * kInt32 + kPose + 2 * kInt32 + 4 * kDouble);
  cursor->Skip(kInt32 + 2 * kDouble + 2 * kInt32);  // from the projection on
  const std::int32_t num_pixels = cursor->Count();
  cursor->SkipArray(num_pixels, kInt16);
  SkipArrays(cursor, 2, num_pixels, kByte);
}

template <>
void WalkShape<feature_set_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64 + 2 * kInt32);
  cursor->SkipString();
  cursor->Skip(kInt32 + kDouble);
  SkipArrays(cursor, 6, cursor->Count(), kFloat);
  cursor->SkipArray(cursor->Count(), kInt16);
}

template <>
void WalkShape<object_model_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64 + 2 * kInt32);
  cursor->SkipString();
  cursor->SkipString();
  cursor->Skip(kBox + kDouble);
  cursor->SkipString();
  cursor->Skip(kInt32 + kDouble);
  SkipArrays(cursor, 6, cursor->Count(), kFloat);
  cursor->SkipArray(cursor->Count(), 3 * kDouble + 3 * kInt32);
  SkipArrays(cursor, 6, cursor->Count(), kFloat);
  cursor->SkipArray(cursor->Count(), kInt16);
  SkipArrays(cursor, 6, cursor->Count(), kFloat);
  SkipArrays(cursor, 3, cursor->Count(), kFloat);
}

template <>
void WalkShape<pose_hypotheses_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64 + kInt32);
  const std::int32_t count = cursor->Count();
  for (std::int32_t i = 0; i < count && cursor->ok(); ++i) {
    cursor->SkipString();
    cursor->Skip(kPose + kFloat + kByte);
  }
}

template <>
void WalkShape<detections_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64 + kPose + kInt32);
  const std::int32_t count = cursor->Count();
  for (std::int32_t i = 0; i < count && cursor->ok(); ++i) SkipDetection(cursor);
  SkipStageTimes(cursor);
}

template <>
void WalkShape<partial_scan_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64 + kInt32);
  WalkShape<scan_t>(cursor);
}

template <>
void WalkShape<scan_end_t>(ShapeCursor* cursor) {
  cursor->Skip(2 * kInt64 + 5 * kInt32 + kPose);
}

template <>
void WalkShape<partial_range_image_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64);
  WalkShape<range_image_t>(cursor);
}

template <>
void WalkShape<partial_feature_set_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64);
  WalkShape<feature_set_t>(cursor);
}

template <>
void WalkShape<early_detections_t>(ShapeCursor* cursor) {
  cursor->Skip(2 * kInt64 + kByte + kPose + kInt32);
  const std::int32_t count = cursor->Count();
  for (std::int32_t i = 0; i < count && cursor->ok(); ++i) {
    cursor->Skip(kInt64 + kByte + kInt64 + kDouble);
    SkipDetection(cursor);
  }
}

template <>
void WalkShape<shard_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64);
  cursor->SkipString();
  cursor->Skip(2 * kInt32 + 2 * kInt64 + kInt32);
}

template <>
void WalkShape<shard_scan_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64);
  WalkShape<shard_t>(cursor);
  cursor->Skip(kInt64 + kByte);
}

template <>
void WalkShape<shard_turn_t>(ShapeCursor* cursor) {
  cursor->Skip(4 * kInt64);
}

template <>
void WalkShape<shard_candidates_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64 + 2 * kInt32);
  WalkShape<shard_t>(cursor);
  cursor->Skip(kInt64 + kInt32 + kPose + kInt32);
  const std::int32_t num_models = cursor->Count();
  for (std::int32_t i = 0; i < num_models && cursor->ok(); ++i) {
    cursor->SkipString();
    cursor->Skip(kBox);
  }
  cursor->SkipArray(cursor->Count(), kInt32 + 14 * kDouble + kInt32);
  SkipArrays(cursor, 2, cursor->Count(), kInt32);
  SkipStageTimes(cursor);
}

template <>
void WalkShape<status_t>(ShapeCursor* cursor) {
  cursor->Skip(kInt64);
  cursor->SkipString();
  cursor->SkipString();
  cursor->Skip(kInt32);
  cursor->SkipString();
  cursor->Skip(4 * kInt64);
  const std::int32_t count = cursor->Count();
  for (std::int32_t i = 0; i < count && cursor->ok(); ++i) {
    cursor->SkipString();
    cursor->Skip(kInt64);
  }
  SkipStageTimes(cursor);
  cursor->SkipString();
}

std::string CheckBytes(const void* bytes, std::size_t size, std::size_t max_size,
                       std::int64_t fingerprint, void (*walk)(ShapeCursor*)) {
  if (size == 0) return "is empty";
  if (size > max_size) return "is too large";
  if (size < kInt64) return "is cut off";
  const auto* const begin = static_cast<const std::uint8_t*>(bytes);
  if (ReadBigEndian(begin, kInt64) != static_cast<std::uint64_t>(fingerprint)) {
    return "is of another type";
  }
  ShapeCursor cursor(begin + kInt64, size - kInt64);
  walk(&cursor);
  if (!cursor.ok()) return cursor.error();
  return cursor.at_end() ? "" : "has bytes left over";
}

}  // namespace rimod
