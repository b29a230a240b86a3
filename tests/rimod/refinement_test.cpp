#include "rimod/refinement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/io/random_values.h"
#include "tests/support/matchers.h"
#include "tests/support/ray_caster.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

const Eigen::Isometry3d kPose = Placed(2.2, 0.1, -1.1, 0.5);
const Eigen::Vector3d kSize(0.5, 0.4, 0.6);

// A crate before a wall on a floor.
Scene SceneWithCrate(const Eigen::Isometry3d& pose) {
  World world;
  world.planes = {{Eigen::Vector3d(4, 0, 0), -Eigen::Vector3d::UnitX()},
                  {Eigen::Vector3d(0, 0, -1.1), Eigen::Vector3d::UnitZ()}};
  BoxShape box;
  box.T_local_box = pose * Eigen::Translation3d(0, 0, 0.3);
  box.half_size = 0.5 * kSize;
  world.boxes = {box};
  RangeImageParams params;
  params.resolution = 0.0069;
  return Scene(
      MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{}), params), 0.05,
      Execution{});
}

const Scene& CrateScene() {
  static const Scene scene = SceneWithCrate(kPose);
  return scene;
}

const SurfaceSample& Crate() {
  static const SurfaceSample sample = [] {
    const ObjectModel model = BoxModel("crate", kSize, 0.03);
    return SurfaceSample{model.points, model.normals};
  }();
  return sample;
}

RefinementSchedule Schedule(int iterations, double damping) {
  RefinementSchedule schedule;
  schedule.iterations = iterations;
  schedule.first_gate = 0.15;
  schedule.last_gate = 0.05;
  schedule.damping = schedule.tilt_damping = damping;
  return schedule;
}

Eigen::Isometry3d Refine(const Eigen::Isometry3d& start,
                         const RefinementSchedule& schedule = Schedule(15, 0.001)) {
  return RefinePose(CrateScene(), Crate(), start.cast<float>(), schedule).cast<double>();
}

TEST(RefinePoseTest, StaysAtTheTruePose) {
  EXPECT_TRUE(PosesNear(Refine(kPose), kPose, 0.01, 0.02));
}

TEST(RefinePoseTest, ComesBackFromNearby) {
  RandomValues random(1);
  for (int i = 0; i < 20; ++i) {
    Eigen::Isometry3d start = kPose;
    start.pretranslate(random.Vector(0.05));
    start.rotate(Eigen::AngleAxisd(random.Between(-0.1, 0.1), Eigen::Vector3d::UnitZ()));
    start.rotate(Eigen::AngleAxisd(random.Between(-0.05, 0.05), Eigen::Vector3d::UnitX()));
    EXPECT_TRUE(PosesNear(Refine(start), kPose, 0.015, 0.03)) << i;
  }
}

TEST(RefinePoseTest, StrongDampingOfTheTiltKeepsItUpright) {
  Eigen::Isometry3d start = kPose;
  start.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  RefinementSchedule schedule = Schedule(10, 0.001);
  schedule.tilt_damping = 1000.0;
  const double stiff = Refine(start, schedule).linear()(2, 2);
  EXPECT_NEAR(stiff, std::cos(0.1), 1e-3);
}

// A pose that is turned by an angle (rad) about the object's x-axis.
Eigen::Isometry3d Leaning(Eigen::Isometry3d pose, double angle) {
  pose.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()));
  return pose;
}

TEST(StandUprightTest, TurnsUprightAndFindsHeadingAndPlace) {
  for (const double angle : {-0.2, -0.04, 0.0, 0.04}) {
    Eigen::Isometry3d start = kPose;
    start.pretranslate(Eigen::Vector3d(0.01, -0.02, 0.01));
    start.rotate(Eigen::AngleAxisd(0.04, Eigen::Vector3d::UnitZ()));
    const Eigen::Isometry3f leaning = Leaning(start, angle).cast<float>();
    const Eigen::Isometry3f upright =
        StandUpright(CrateScene(), Crate(), leaning, Schedule(1, 0.001));
    EXPECT_NEAR(TiltOf(leaning), std::abs(angle), 1e-3);
    EXPECT_LT(TiltOf(upright), 1e-3) << angle;
    if (std::abs(angle) < 0.1) {
      EXPECT_TRUE(PosesNear(upright.cast<double>(), kPose, 0.01, 0.02)) << angle;
    }
  }
  const Eigen::Isometry3f pose = Leaning(kPose, 0.04).cast<float>();
  EXPECT_EQ(StandUpright(CrateScene(), SurfaceSample{}, pose, Schedule(1, 0.001)).matrix(),
            pose.matrix());
}

TEST(RefinePoseTest, WhatLeansIsFoundLeaning) {
  const Eigen::Isometry3d leaning = Leaning(kPose, 0.12);
  const Scene scene = SceneWithCrate(leaning);
  const Eigen::Isometry3f refined =
      RefinePose(scene, Crate(), kPose.cast<float>(), Schedule(15, 0.001));
  EXPECT_TRUE(PosesNear(refined.cast<double>(), leaning, 0.02, 0.04));
}

TEST(RefinePoseTest, NothingToPairLeavesThePoseAsItIs) {
  RandomValues random(3);
  for (const Eigen::Isometry3d& start :
       {Placed(2.2, 0.1, 5.0, 0.5), Placed(-3, 0, 0, 0), Placed(1.0, 0, -0.3, 0)})
    EXPECT_TRUE(PosesNear(Refine(start), start, 1e-6, 1e-3));
  const Eigen::Isometry3f start = kPose.cast<float>();
  EXPECT_EQ(RefinePose(CrateScene(), SurfaceSample{}, start, Schedule(5, 0.01)).matrix(),
            start.matrix());
  const Scene empty(RangeImage(), 0.05, Execution{});
  EXPECT_EQ(RefinePose(empty, Crate(), start, Schedule(5, 0.01)).matrix(), start.matrix());
  EXPECT_TRUE(PosesNear(Refine(kPose, Schedule(0, 0.001)), kPose, 1e-6, 1e-3));
}

TEST(RefinePoseTest, WhatTheSurfaceDoesNotDetermineStays) {
  // A plate in a wall may slide along it: damping holds it where it was.
  World world;
  world.planes = {{Eigen::Vector3d(3, 0, 0), -Eigen::Vector3d::UnitX()}};
  RangeImageParams params;
  params.resolution = 0.0069;
  const Scene scene(
      MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{}), params), 0.05,
      Execution{});
  const ObjectModel plate = PlateModel("plate", 0.5, 0.03);
  const Eigen::Isometry3d start = Placed(2.95, 0.2, -0.3, M_PI + 0.03);
  const Eigen::Isometry3d refined =
      RefinePose(scene, {plate.points, plate.normals}, start.cast<float>(), Schedule(15, 0.01))
          .cast<double>();
  EXPECT_NEAR(refined.translation().x(), 3.0, 0.01);
  EXPECT_NEAR(refined.translation().y(), 0.2, 0.02);
  EXPECT_NEAR(refined.translation().z(), -0.3, 0.02);
  EXPECT_NEAR(refined.linear().col(0).x(), -1.0, 1e-3);
}

}  // namespace
}  // namespace rimod
