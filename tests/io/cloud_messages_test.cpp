#include "io/cloud_messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>

#include "io/message_codec.h"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

SensorCloud RandomCloud(int num_points) {
  RandomValues random(1);
  SensorCloud cloud;
  cloud.time = Time(1234567);
  for (int i = 0; i < num_points; ++i) cloud.points.push_back(random.Vector(30.0).cast<float>());
  return cloud;
}

std::string ErrorOf(const bot_core::pointcloud2_t& message) {
  const SensorCloudFromMessage result = FromMessage(message);
  EXPECT_NE(result.cloud.has_value(), !result.error.empty());
  return result.error;
}

// A record of 32 bytes, coordinates in odd places among other fields, rows padded by 5 bytes.
template <typename Value>
bot_core::pointcloud2_t OddMessage(const std::vector<Eigen::Vector3f>& points, int width,
                                   bool turned) {
  bot_core::pointcloud2_t message = ToMessage(SensorCloud{Time(5), {}}, "odd");
  const int height = static_cast<int>(points.size()) / width;
  message.height = height;
  message.width = width;
  message.point_step = 32;
  message.row_step = width * message.point_step + 5;
  message.data.assign(static_cast<std::size_t>(message.row_step) * height - 5, 0xee);
  message.data_nbytes = static_cast<std::int32_t>(message.data.size());
  const int offsets[] = {23, 3, 12};
  for (int i = 0; i < 3; ++i) {
    message.fields[static_cast<std::size_t>(i)].offset = offsets[i];
    message.fields[static_cast<std::size_t>(i)].datatype = sizeof(Value) == 8 ? 8 : 7;
  }
  bot_core::pointfield_t intensity = {};
  intensity.name = "intensity";
  intensity.offset = 1000;  // nobody reads it
  intensity.datatype = 2;
  message.fields.insert(message.fields.begin(), intensity);
  message.nfields = 4;
  if (turned) message.is_bigendian = message.is_bigendian ? 0 : 1;
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::uint8_t* const record = message.data.data() + p / width * message.row_step +
                                 p % width * static_cast<std::size_t>(message.point_step);
    for (int i = 0; i < 3; ++i) {
      const Value value = static_cast<Value>(points[p][i]);
      std::uint8_t bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      if (turned) std::reverse(bytes, bytes + sizeof value);
      std::memcpy(record + offsets[i], bytes, sizeof value);
    }
  }
  return message;
}

TEST(CloudMessagesTest, PointsComeBackBitForBit) {
  const SensorCloud cloud = RandomCloud(1000);
  const SensorCloudFromMessage back = FromMessage(ToMessage(cloud, "lidar"));
  ASSERT_TRUE(back.cloud) << back.error;
  EXPECT_EQ(back.cloud->time, cloud.time);
  EXPECT_EQ(back.cloud->points, cloud.points);
}

TEST(CloudMessagesTest, AnyOffsetTypeByteOrderAndPaddingGivesTheSamePoints) {
  const std::vector<Eigen::Vector3f> points = RandomCloud(12).points;
  for (const bool turned : {false, true}) {
    const SensorCloudFromMessage floats = FromMessage(OddMessage<float>(points, 4, turned));
    ASSERT_TRUE(floats.cloud) << floats.error;
    EXPECT_EQ(floats.cloud->points, points);
    const SensorCloudFromMessage doubles = FromMessage(OddMessage<double>(points, 3, turned));
    ASSERT_TRUE(doubles.cloud) << doubles.error;
    EXPECT_EQ(doubles.cloud->points, points);
  }
}

TEST(CloudMessagesTest, PointsThatAreNoneAreLeftOut) {
  SensorCloud cloud;
  const float infinity = std::numeric_limits<float>::infinity();
  cloud.points = {{kNan, 1, 1}, {1, 2, 3}, {1, infinity, 1}, {0, 0, 0}, {0, 0, 1}};
  const SensorCloudFromMessage back = FromMessage(ToMessage(cloud, ""));
  ASSERT_TRUE(back.cloud);
  EXPECT_EQ(back.cloud->points, (std::vector<Eigen::Vector3f>{{1, 2, 3}, {0, 0, 1}}));
  // A double that no float holds.
  bot_core::pointcloud2_t message = OddMessage<double>({{1, 2, 3}}, 1, false);
  const double huge = 1e300;
  std::memcpy(message.data.data() + 23, &huge, sizeof huge);
  ASSERT_TRUE(FromMessage(message).cloud);
  EXPECT_TRUE(FromMessage(message).cloud->points.empty());
}

TEST(CloudMessagesTest, AnEmptyCloudIsACloud) {
  const SensorCloudFromMessage back = FromMessage(ToMessage(SensorCloud{}, ""));
  ASSERT_TRUE(back.cloud) << back.error;
  EXPECT_TRUE(back.cloud->points.empty());
}

// Found by the fuzzer: rows without pixels have no bytes that would bound their number.
TEST(CloudMessagesTest, TwoThousandMillionEmptyRowsTakeNoTime) {
  bot_core::pointcloud2_t message = ToMessage(SensorCloud{}, "");
  message.height = std::numeric_limits<std::int32_t>::max();
  message.width = 0;
  const SensorCloudFromMessage back = FromMessage(message);
  ASSERT_TRUE(back.cloud) << back.error;
  EXPECT_TRUE(back.cloud->points.empty());
}

TEST(CloudMessagesTest, HabitsOfOldDriversAreTaken) {
  bot_core::pointcloud2_t message = ToMessage(RandomCloud(3), "");
  message.row_step = 0;
  for (bot_core::pointfield_t& field : message.fields) field.count = 0;
  ASSERT_TRUE(FromMessage(message).cloud);
  EXPECT_EQ(FromMessage(message).cloud->points, RandomCloud(3).points);
}

TEST(CloudMessagesTest, WhatDoesNotFitIsNamed) {
  const bot_core::pointcloud2_t good = ToMessage(RandomCloud(3), "");
  const auto error = [&good](const std::function<void(bot_core::pointcloud2_t*)>& spoil) {
    bot_core::pointcloud2_t bad = good;
    spoil(&bad);
    return ErrorOf(bad);
  };
  using Message = bot_core::pointcloud2_t;
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
  EXPECT_EQ(error([](Message* m) { m->fields[1].name = "v"; }), "has no field y");
  EXPECT_EQ(error([](Message* m) { m->fields[1].name = "x"; }), "has more than one field x");
  for (const int datatype : {-128, -1, 0, 1, 6, 9, 127}) {
    EXPECT_EQ(
        error([&](Message* m) { m->fields[2].datatype = static_cast<std::int8_t>(datatype); }),
        "field z is neither FLOAT32 (7) nor FLOAT64 (8)");
  }
  EXPECT_EQ(error([](Message* m) { m->fields[2].datatype = 8; }),
            "field z is not within point_step");
  for (const std::int32_t offset : {kLeast, -1, 9, 12, kMost}) {
    EXPECT_EQ(error([&](Message* m) { m->fields[2].offset = offset; }),
              "field z is not within point_step");
  }
  for (const std::int32_t count : {kLeast, -1, 2, kMost}) {
    EXPECT_EQ(error([&](Message* m) { m->fields[0].count = count; }), "field x is a list");
  }
  for (const std::int32_t step : {kLeast, -12, 0}) {
    EXPECT_EQ(error([&](Message* m) { m->point_step = step; }), "point_step is not positive");
  }
  EXPECT_NE(error([&](Message* m) { m->point_step = kMost; }), "");
  for (const std::int32_t row_step : {kLeast, -1, 1, 35}) {
    EXPECT_EQ(error([&](Message* m) { m->row_step = row_step; }), "row_step is shorter than a row");
  }
  for (const std::int32_t count : {kLeast, -1}) {
    EXPECT_EQ(error([&](Message* m) { m->width = count; }), "a count does not fit its list");
    EXPECT_EQ(error([&](Message* m) { m->height = count; }), "a count does not fit its list");
    EXPECT_EQ(error([&](Message* m) { m->data_nbytes = count; }), "a count does not fit its list");
    EXPECT_EQ(error([&](Message* m) { m->nfields = count; }), "a count does not fit its list");
  }
  EXPECT_EQ(error([](Message* m) { m->height = 2; }), "has fewer bytes than its rows");
  EXPECT_EQ(error([&](Message* m) { m->height = kMost; }), "has fewer bytes than its rows");
  EXPECT_NE(error([&](Message* m) { m->width = kMost; }), "");
  EXPECT_NE(error([&](Message* m) { m->width = m->height = kMost; }), "");
  EXPECT_EQ(error([](Message* m) {
              m->width = 4;
              m->row_step = 48;
            }),
            "has fewer bytes than its rows");
  EXPECT_EQ(error([](Message* m) {
              m->row_step = 0;
              m->height = 2;
            }),
            "row_step is shorter than a row");
}

TEST(CloudMessagesTest, RandomNumbersNeverReadOutsideTheBytes) {
  RandomValues random(7);
  const auto any = [&random]() -> std::int32_t {
    return random.Int(0, 3) == 0
               ? random.Int(std::numeric_limits<int>::min(), std::numeric_limits<int>::max())
               : random.Int(-2, 40);
  };
  int num_good = 0;
  for (int i = 0; i < 20000; ++i) {
    bot_core::pointcloud2_t message = ToMessage(RandomCloud(6), "");
    for (std::int32_t* const number :
         {&message.height, &message.width, &message.point_step, &message.row_step,
          &message.fields[0].offset, &message.fields[1].offset, &message.fields[2].offset}) {
      if (random.Int(0, 2) == 0) *number = any();
    }
    const SensorCloudFromMessage result = FromMessage(message);
    if (!result.cloud) continue;
    ++num_good;
    EXPECT_LE(result.cloud->points.size(), message.data.size());
  }
  EXPECT_GT(num_good, 100);
}

}  // namespace
}  // namespace rimod
