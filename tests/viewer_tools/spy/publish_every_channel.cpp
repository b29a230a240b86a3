// Publishes a message of the right type on each of rimod's channels, ten times a second, until it
// is ended or 60 seconds are over.
#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <thread>

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

int main() {
  lcm::LCM lcm;
  if (!lcm.good()) return 1;
  const rimod::Channels channels;
  const bot_core::planar_lidar_t line{};
  const bot_core::rigid_transform_t pose{};
  const rimod::scan_t scan{};
  const rimod::range_image_t image{};
  const rimod::feature_set_t features{};
  const rimod::object_model_t model{};
  const rimod::pose_hypotheses_t hypotheses{};
  const rimod::detections_t detections{};
  const rimod::status_t status{};
  for (int i = 0; i < 600; ++i) {
    lcm.publish(channels.laser, &line);
    lcm.publish(channels.laser_to_local, &pose);
    lcm.publish(channels.scan, &scan);
    lcm.publish(channels.range_image, &image);
    lcm.publish(channels.features, &features);
    lcm.publish(channels.model, &model);
    lcm.publish(channels.hypotheses, &hypotheses);
    lcm.publish(channels.detections, &detections);
    lcm.publish(channels.status, &status);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}
