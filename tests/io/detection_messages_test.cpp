#include "io/detection_messages.h"

#include <gtest/gtest.h>

#include <limits>

#include "io/message_codec.h"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

std::vector<PoseHypothesis> Hypotheses(RandomValues* random, int number) {
  std::vector<PoseHypothesis> hypotheses;
  for (int i = 0; i < number; ++i) {
    // Scores that a float holds exactly.
    hypotheses.push_back({"fan", random->Pose(), random->Int(0, 1024) / 1024.0,
                          static_cast<HypothesisStage>(random->Int(0, 3))});
  }
  return hypotheses;
}

StampedDetections Detections(RandomValues* random, int number) {
  StampedDetections detections;
  detections.utime = 42;
  detections.T_local_sensor = random->Level();
  detections.num_models = 7;
  detections.stage_times = {{"matching", 12.5}, {"total", 99.0}};
  for (int i = 0; i < number; ++i) {
    const Eigen::Vector3d corner = random->Vector(1.0);
    detections.detections.push_back({"office_chair", random->Pose(), corner,
                                     corner + Eigen::Vector3d(0.5, 0.6, 0.7),
                                     random->Between(0.0, 1.0)});
  }
  return detections;
}

template <typename Message>
Message ThroughBytes(const Message& message) {
  const std::vector<std::uint8_t> bytes = EncodeMessage(message);
  EXPECT_LE(bytes.size(), static_cast<std::size_t>(kMaxMessageBytes));
  return DecodeMessage<Message>(bytes.data(), bytes.size()).message.value();
}

TEST(DetectionMessagesTest, HypothesesComeBack) {
  RandomValues random(1);
  for (const int number : {0, 1, 100}) {
    const std::vector<PoseHypothesis> sent = Hypotheses(&random, number);
    const pose_hypotheses_t message = ThroughBytes(ToMessage(sent, number + 5, 17));
    EXPECT_EQ(message.utime, 17);
    EXPECT_EQ(message.num_found, number + 5);
    const HypothesesFromMessage received = FromMessage(message);
    ASSERT_TRUE(received.hypotheses) << received.error;
    ASSERT_EQ(received.hypotheses->size(), sent.size());
    for (std::size_t i = 0; i < sent.size(); ++i) {
      const PoseHypothesis& hypothesis = (*received.hypotheses)[i];
      EXPECT_EQ(hypothesis.class_name, sent[i].class_name);
      EXPECT_TRUE(hypothesis.T_local_object.isApprox(sent[i].T_local_object, 1e-13));
      EXPECT_EQ(hypothesis.score, sent[i].score);
      EXPECT_EQ(hypothesis.stage, sent[i].stage);
    }
  }
}

TEST(DetectionMessagesTest, DetectionsComeBack) {
  RandomValues random(2);
  for (const int number : {0, 1, 30}) {
    const StampedDetections sent = Detections(&random, number);
    const DetectionsFromMessage received = FromMessage(ThroughBytes(ToMessage(sent)));
    ASSERT_TRUE(received.detections) << received.error;
    EXPECT_EQ(received.detections->utime, sent.utime);
    EXPECT_EQ(received.detections->T_local_sensor.matrix(), sent.T_local_sensor.matrix());
    EXPECT_EQ(received.detections->num_models, sent.num_models);
    EXPECT_EQ(received.detections->stage_times, sent.stage_times);
    ASSERT_EQ(received.detections->detections.size(), sent.detections.size());
    for (std::size_t i = 0; i < sent.detections.size(); ++i) {
      const Detection& detection = received.detections->detections[i];
      EXPECT_EQ(detection.class_name, sent.detections[i].class_name);
      EXPECT_TRUE(detection.T_local_object.isApprox(sent.detections[i].T_local_object, 1e-13));
      EXPECT_EQ(detection.box_min, sent.detections[i].box_min);
      EXPECT_EQ(detection.box_max, sent.detections[i].box_max);
      EXPECT_EQ(detection.score, sent.detections[i].score);
    }
  }
}

TEST(DetectionMessagesTest, OfTooManyTheFirstFit) {
  RandomValues random(3);
  const std::vector<PoseHypothesis> hypotheses = Hypotheses(&random, 5000);
  const pose_hypotheses_t message = ThroughBytes(ToMessage(hypotheses, 5000, 0));
  EXPECT_GT(message.num_hypotheses, 1000);
  EXPECT_LT(message.num_hypotheses, 5000);
  EXPECT_EQ(message.num_found, 5000);
  EXPECT_EQ(message.hypotheses[0].score, static_cast<float>(hypotheses[0].score));

  const detections_t detections = ThroughBytes(ToMessage(Detections(&random, 5000)));
  EXPECT_GT(detections.num_detections, 500);
  EXPECT_LT(detections.num_detections, 5000);
}

TEST(DetectionMessagesTest, BadHypothesesAreRejected) {
  RandomValues random(4);
  const pose_hypotheses_t good = ToMessage(Hypotheses(&random, 3), 3, 0);
  const auto error_after = [&good](void (*change)(pose_hypotheses_t*)) {
    pose_hypotheses_t bad = good;
    change(&bad);
    const HypothesesFromMessage result = FromMessage(bad);
    EXPECT_FALSE(result.hypotheses);
    return result.error;
  };
  using Message = pose_hypotheses_t;
  EXPECT_EQ(error_after([](Message* m) { m->num_hypotheses = -1; }),
            "a count does not fit its list");
  EXPECT_EQ(error_after([](Message* m) { m->num_hypotheses = 4; }),
            "a count does not fit its list");
  EXPECT_EQ(error_after([](Message* m) { m->num_found = 2; }), "a count does not fit its list");
  EXPECT_EQ(error_after([](Message* m) { m->hypotheses[1].orientation[0] += 1.0; }),
            "a pose is not a pose");
  EXPECT_EQ(error_after([](Message* m) {
              m->hypotheses[1].position[0] = std::numeric_limits<double>::infinity();
            }),
            "a pose is not a pose");
  EXPECT_EQ(error_after([](Message* m) { m->hypotheses[1].class_name = "../etc"; }),
            "a class name is not valid");
  EXPECT_EQ(error_after([](Message* m) { m->hypotheses[1].score = 1.5f; }),
            "a score is not within 0 .. 1");
  EXPECT_EQ(error_after([](Message* m) { m->hypotheses[1].stage = 4; }), "a stage is unknown");
  EXPECT_EQ(error_after([](Message* m) { m->hypotheses[1].stage = -1; }), "a stage is unknown");
}

TEST(DetectionMessagesTest, BadDetectionsAreRejected) {
  RandomValues random(5);
  const detections_t good = ToMessage(Detections(&random, 3));
  const auto error_after = [&good](void (*change)(detections_t*)) {
    detections_t bad = good;
    change(&bad);
    const DetectionsFromMessage result = FromMessage(bad);
    EXPECT_FALSE(result.detections);
    return result.error;
  };
  using Message = detections_t;
  EXPECT_EQ(error_after([](Message* m) { m->num_detections = -3; }),
            "a count does not fit its list");
  EXPECT_EQ(error_after([](Message* m) { m->num_stage_times = 1; }),
            "a count does not fit its list");
  EXPECT_EQ(error_after([](Message* m) { m->sensor_orientation[0] = 9.0; }),
            "sensor pose is not a pose");
  EXPECT_EQ(error_after([](Message* m) {
              m->detections[0].orientation[2] = std::numeric_limits<double>::quiet_NaN();
            }),
            "a pose is not a pose");
  EXPECT_EQ(error_after([](Message* m) { m->detections[0].class_name = ""; }),
            "a class name is not valid");
  EXPECT_EQ(error_after([](Message* m) {
              m->detections[0].score = std::numeric_limits<double>::quiet_NaN();
            }),
            "a score is not within 0 .. 1");
  EXPECT_EQ(error_after([](Message* m) { m->detections[0].box_min[1] = 1e6; }),
            "a box is not a box");
}

}  // namespace
}  // namespace rimod
