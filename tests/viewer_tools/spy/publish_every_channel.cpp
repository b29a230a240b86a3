// Publishes on each of rimod's channels, ten times a second, until it is ended or 60 seconds are
// over: a range image in several sections, detections and a status, and of each other type a
// message without content.
#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <thread>
#include <vector>

#include "bot_core/planar_lidar_t.hpp"
#include "bot_core/rigid_transform_t.hpp"
#include "io/channels.h"
#include "rimod/detections_t.hpp"
#include "rimod/feature_set_t.hpp"
#include "rimod/object_model_t.hpp"
#include "rimod/pose_hypotheses_t.hpp"
#include "rimod/range_image_t.hpp"
#include "rimod/scan_t.hpp"
#include "rimod/status_t.hpp"
#include "tests/io/random_values.h"
#include "tests/support/sample_messages.h"

int main() {
  lcm::LCM lcm;
  if (!lcm.good()) return 1;
  const rimod::Channels channels;
  const bot_core::planar_lidar_t line{};
  const bot_core::rigid_transform_t pose{};
  const rimod::scan_t scan{};
  const std::vector<rimod::range_image_t> image =
      ToSections(rimod::RandomValues(1).AnImage(200, 150), 5);
  const rimod::feature_set_t features{};
  const rimod::object_model_t model{};
  const rimod::pose_hypotheses_t hypotheses{};
  const auto detections = rimod::SampleMessage<rimod::detections_t>();
  const auto status = rimod::SampleMessage<rimod::status_t>();
  for (int i = 0; i < 600; ++i) {
    lcm.publish(channels.laser, &line);
    lcm.publish(channels.laser_to_local, &pose);
    lcm.publish(channels.scan, &scan);
    for (const rimod::range_image_t& section : image) lcm.publish(channels.range_image, &section);
    lcm.publish(channels.features, &features);
    lcm.publish(channels.model, &model);
    lcm.publish(channels.hypotheses, &hypotheses);
    lcm.publish(channels.detections, &detections);
    lcm.publish(channels.status, &status);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}
