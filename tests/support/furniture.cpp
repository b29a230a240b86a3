#include "tests/support/furniture.h"

#include <cmath>

namespace rimod {
namespace {

BoxShape Part(const Eigen::Vector3d& middle, const Eigen::Vector3d& size) {
  BoxShape box;
  box.T_local_box = Eigen::Isometry3d(Eigen::Translation3d(middle));
  box.half_size = 0.5 * size;
  return box;
}

}  // namespace

Furniture Armchair() {
  return {"armchair",
          {Part({0.0, 0.0, 0.2}, {0.6, 0.6, 0.4}), Part({-0.24, 0.0, 0.45}, {0.12, 0.6, 0.9}),
           Part({0.05, 0.24, 0.3}, {0.5, 0.12, 0.6})},
          {},
          {-0.3, -0.3, 0.0},
          {0.3, 0.3, 0.9}};
}

Furniture Stool() {
  return {"stool",
          {Part({0.0, 0.0, 0.42}, {0.5, 0.3, 0.06}), Part({-0.21, 0.0, 0.2}, {0.06, 0.28, 0.4}),
           Part({0.21, -0.1, 0.2}, {0.06, 0.06, 0.4}), Part({0.1, 0.12, 0.55}, {0.2, 0.05, 0.2})},
          {},
          {-0.25, -0.15, 0.0},
          {0.25, 0.15, 0.65}};
}

Furniture Sculpture() {
  return {
      "sculpture",
      {Part({0.0, 0.0, 0.1}, {0.5, 0.6, 0.2}), Part({0.12, 0.2, 0.35}, {0.2, 0.1, 0.3}),
       Part({-0.15, -0.05, 0.3}, {0.12, 0.3, 0.2}), Part({0.1, -0.2, 0.26}, {0.25, 0.08, 0.12})},
      {{{0.05, 0.0, 0.35}, 0.15},
       {{-0.15, 0.17, 0.3}, 0.1},
       {{-0.12, -0.12, 0.45}, 0.12},
       {{0.15, 0.2, 0.58}, 0.1}},
      {-0.25, -0.3, 0.0},
      {0.25, 0.3, 0.68}};
}

void Place(const Furniture& furniture, const Eigen::Isometry3d& T_local_object, World* world) {
  for (BoxShape part : furniture.parts) {
    part.T_local_box = T_local_object * part.T_local_box;
    world->boxes.push_back(part);
  }
  for (const SphereShape& ball : furniture.balls)
    world->spheres.push_back({T_local_object * ball.centre, ball.radius});
}

Recording Record(const Furniture& furniture) {
  Recording recording;
  recording.class_name = furniture.name;
  recording.box_min = furniture.box_min;
  recording.box_max = furniture.box_max;
  World world;
  world.planes = {{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()}};
  Place(furniture, recording.T_local_object, &world);
  BeamPattern pattern;
  pattern.azimuth_min = -0.4;
  pattern.azimuth_max = 0.4;
  pattern.elevation_min = -0.8;
  pattern.elevation_max = 0.1;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d position(2 * std::cos(i * M_PI / 4), 2 * std::sin(i * M_PI / 4), 1.1);
    recording.scans.push_back(ScanWorld(world, LookAt(position, Eigen::Vector3d::Zero()), pattern));
  }
  return recording;
}

}  // namespace rimod
