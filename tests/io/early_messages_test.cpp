#include "io/early_messages.h"

#include <gtest/gtest.h>

#include "io/detection_messages.h"
#include "io/message_codec.h"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

EarlyObject Object(std::int64_t id, EarlyStatus status) {
  EarlyObject object;
  object.id = id;
  object.status = status;
  object.first_told = Time(77);
  object.unseen_share = 0.25;
  object.detection.class_name = "fan";
  object.detection.T_local_object = RandomValues(static_cast<unsigned>(id)).Pose();
  object.detection.box_max = Eigen::Vector3d(1, 2, 3);
  object.detection.score = 0.75;
  return object;
}

TEST(EarlyMessagesTest, TellsAllThatIsKnownOfEachObject) {
  StampedEarlyObjects early;
  early.utime = 5;
  early.known_until = 99;
  early.num_models = 7;
  early.is_final = true;
  early.T_local_sensor = RandomValues(3).Level();
  early.objects = {Object(1, EarlyStatus::kNew), Object(2, EarlyStatus::kConfirmed),
                   Object(3, EarlyStatus::kUnseen), Object(9, EarlyStatus::kWithdrawn)};
  const early_detections_t message = ToMessage(early);
  EXPECT_EQ(message.utime, 5);
  EXPECT_EQ(message.utime_end, 99);
  EXPECT_TRUE(message.is_final);
  EXPECT_EQ(message.num_models, 7);
  ASSERT_EQ(message.num_detections, 4);
  const std::int8_t states[] = {early_detection_t::STATUS_NEW, early_detection_t::STATUS_CONFIRMED,
                                early_detection_t::STATUS_UNSEEN,
                                early_detection_t::STATUS_WITHDRAWN};
  for (std::size_t i = 0; i < 4; ++i) {
    const early_detection_t& item = message.detections[i];
    EXPECT_EQ(item.id, early.objects[i].id);
    EXPECT_EQ(item.status, states[i]);
    EXPECT_EQ(item.first_utime, 77);
    EXPECT_EQ(item.unseen_share, 0.25);
    EXPECT_EQ(EncodeMessage(item.detection), EncodeMessage(ToMessage(early.objects[i].detection)));
  }
}

TEST(EarlyMessagesTest, WhatIsToldComesBack) {
  StampedEarlyObjects early;
  early.utime = 5;
  early.known_until = 99;
  early.objects = {Object(1, EarlyStatus::kNew), Object(3, EarlyStatus::kUnseen)};
  const EarlyObjectsFromMessage back = FromMessage(ToMessage(early));
  ASSERT_TRUE(back.early) << back.error;
  EXPECT_EQ(EncodeMessage(ToMessage(*back.early)), EncodeMessage(ToMessage(early)));
}

TEST(EarlyMessagesTest, UnusableMessagesAreErrors) {
  StampedEarlyObjects early;
  early.objects = {Object(1, EarlyStatus::kNew)};
  const early_detections_t good = ToMessage(early);
  const auto error_after = [&](void (*change)(early_detections_t*)) {
    early_detections_t message = good;
    change(&message);
    return FromMessage(message).error;
  };
  EXPECT_NE(error_after([](early_detections_t* m) { m->num_detections = 2; }), "");
  EXPECT_NE(error_after([](early_detections_t* m) { m->detections[0].status = 4; }), "");
  EXPECT_NE(error_after([](early_detections_t* m) { m->detections[0].unseen_share = 1.5; }), "");
  EXPECT_NE(error_after([](early_detections_t* m) { m->detections[0].detection.score = 2.0; }), "");
}

TEST(EarlyMessagesTest, NoMessageIsLargerThanMessagesMayBe) {
  StampedEarlyObjects early;
  for (std::int64_t id = 1; id <= 2000; ++id) {
    early.objects.push_back(Object(id, EarlyStatus::kNew));
  }
  const early_detections_t message = ToMessage(early);
  EXPECT_LE(EncodeMessage(message).size(), static_cast<std::size_t>(kMaxMessageBytes));
  EXPECT_GT(message.num_detections, 500);
  EXPECT_EQ(message.detections.back().id, message.num_detections);
}

}  // namespace
}  // namespace rimod
