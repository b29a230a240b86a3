#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "rimod/model_building.h"
#include "tests/support/ray_caster.h"

namespace rimod {

// A pile of boxes of many sizes: an object whose every place looks different, easy to find.
inline void PlacePile(const Eigen::Isometry3d& T_local_object, World* world) {
  std::mt19937 generator(3);
  const auto between = [&generator](double min, double max) {
    return std::uniform_real_distribution<double>(min, max)(generator);
  };
  for (int i = 0; i < 14; ++i) {
    BoxShape box;
    box.half_size = {between(0.05, 0.15), between(0.05, 0.15), between(0.05, 0.2)};
    Eigen::Isometry3d T_object_box =
        Placed(between(-0.15, 0.15), between(-0.15, 0.15), between(0.2, 0.7), between(0.0, 3.0));
    T_object_box.rotate(Eigen::AngleAxisd(between(-0.5, 0.5), Eigen::Vector3d::UnitX()));
    box.T_local_box = T_local_object * T_object_box;
    world->boxes.push_back(box);
  }
}

// It from eight sides, on a floor.
inline Recording PileRecording() {
  Recording recording;
  recording.class_name = "pile";
  recording.box_min = {-0.4, -0.4, 0.0};
  recording.box_max = {0.4, 0.4, 0.95};
  World world;
  world.planes = {PlaneShape()};
  PlacePile(recording.T_local_object, &world);
  BeamPattern pattern;
  pattern.azimuth_min = -0.4;
  pattern.azimuth_max = 0.4;
  pattern.elevation_min = -0.8;
  pattern.elevation_max = 0.2;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d position(2 * std::cos(i * M_PI / 4), 2 * std::sin(i * M_PI / 4), 1.1);
    recording.scans.push_back(ScanWorld(world, LookAt(position, Eigen::Vector3d::Zero()), pattern));
  }
  return recording;
}

// A room with the pile at the pose.
inline Scan PileScan(const Eigen::Isometry3d& T_local_object) {
  World world;
  world.planes = {PlaneShape(), {{4.0, 0.0, 0.0}, -Eigen::Vector3d::UnitX()}};
  PlacePile(T_local_object, &world);
  BeamPattern pattern;
  pattern.elevation_min = -0.7;
  return ScanWorld(world, Placed(0.0, 0.0, 1.1, 0.0), pattern);
}

}  // namespace rimod
