#include "rimod/single_correspondence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/io/random_values.h"
#include "tests/support/matchers.h"
#include "tests/support/ray_caster.h"

namespace rimod {
namespace {

constexpr double kVertical = 0.966;

struct Pair {
  Feature scene, model;
  Eigen::Vector3d model_line_of_sight;
};

// A model's feature and what a sensor sees of it when the object stands upright at the pose.
Pair See(const Eigen::Isometry3d& T_sensor_object, const Eigen::Vector3d& position,
         const Eigen::Vector3d& normal) {
  Pair pair;
  pair.model.position = position.cast<float>();
  pair.model.normal = normal.cast<float>();
  pair.scene.position = (T_sensor_object * position).cast<float>();
  pair.scene.normal = (T_sensor_object.linear() * normal).cast<float>();
  pair.model_line_of_sight = T_sensor_object.linear().transpose() * (T_sensor_object * position);
  return pair;
}

TEST(PoseFromCorrespondenceTest, FindsAnyUprightPose) {
  RandomValues random(1);
  int steep = 0;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Isometry3d T = random.Level();
    const Eigen::Vector3d normal = i % 5 == 0 ? Eigen::Vector3d::UnitZ() : random.Unit();
    steep += std::abs(normal.z()) > kVertical;
    const Pair pair = See(T, random.Vector(1.0), normal);
    const std::optional<Eigen::Isometry3d> found =
        PoseFromCorrespondence(pair.scene, pair.model, pair.model_line_of_sight, kVertical, 0.9);
    ASSERT_TRUE(found) << normal.transpose();
    EXPECT_TRUE(PosesNear(*found, T, 1e-3, 1e-4)) << normal.transpose();
  }
  EXPECT_GT(steep, 100);
}

TEST(PoseFromCorrespondenceTest, StandsUprightAndMovesTheFeatureOntoTheScenes) {
  RandomValues random(2);
  for (int i = 0; i < 500; ++i) {
    Pair pair = See(random.Level(), random.Vector(1.0), random.Unit());
    pair.scene.normal = random.Unit().cast<float>();  // another surface
    const std::optional<Eigen::Isometry3d> found =
        PoseFromCorrespondence(pair.scene, pair.model, pair.model_line_of_sight, kVertical, -1.0);
    if (!found) continue;
    EXPECT_NEAR((found->linear().col(2) - Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-9);
    EXPECT_NEAR(
        (*found * pair.model.position.cast<double>() - pair.scene.position.cast<double>()).norm(),
        0.0, 1e-6);
  }
}

TEST(PoseFromCorrespondenceTest, NothingWhereTheNormalsRiseDifferently) {
  const auto tilted = [](double elevation) {
    return Eigen::Vector3d(std::cos(elevation), 0.0, std::sin(elevation));
  };
  Pair pair = See(Placed(2, 0, 0, 0.5), {0, 0, 0.5}, tilted(0.2));
  for (const double difference : {0.1, 0.3, 0.5, 1.0}) {
    const Eigen::Vector3d normal = Placed(2, 0, 0, 0.5).linear() * tilted(0.2 - difference);
    pair.scene.normal = normal.cast<float>();
    EXPECT_EQ(PoseFromCorrespondence(pair.scene, pair.model, pair.model_line_of_sight, kVertical,
                                     std::cos(0.4))
                  .has_value(),
              difference < 0.4);
  }
}

TEST(PoseFromCorrespondenceTest, AFloorIsNoWall) {
  Pair pair = See(Placed(2, 0, 0, 0.5), {0, 0, 0.5}, Eigen::Vector3d::UnitX());
  pair.scene.normal = Eigen::Vector3f::UnitZ();
  EXPECT_FALSE(
      PoseFromCorrespondence(pair.scene, pair.model, pair.model_line_of_sight, kVertical, -1.0));
}

TEST(TiltedToNormalTest, LaysNormalAndPositionOntoTheScenes) {
  RandomValues random(7);
  int tilted_poses = 0;
  for (int i = 0; i < 200; ++i) {
    Feature scene, model;
    scene.position = random.Vector(3.0).cast<float>();
    model.position = random.Vector(0.5).cast<float>();
    model.normal = random.Unit().cast<float>();
    Eigen::Isometry3d upright = Eigen::Isometry3d::Identity();
    upright.linear() =
        Eigen::AngleAxisd(random.Between(-3.0, 3.0), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d turned = upright.linear() * model.normal.cast<double>();
    const double angle = random.Between(0.0, 0.6);
    const Eigen::Vector3d axis = turned.unitOrthogonal();
    scene.normal = (Eigen::AngleAxisd(angle, axis) * turned).cast<float>();
    const std::optional<Eigen::Isometry3d> tilted =
        TiltedToNormal(upright, scene, model, 0.15, 0.5);
    if (!tilted) {
      EXPECT_FALSE(angle > 0.151 && angle < 0.499) << angle;
      continue;
    }
    ++tilted_poses;
    EXPECT_GT(angle, 0.149);
    EXPECT_LT(angle, 0.501);
    EXPECT_LT((*tilted * model.position.cast<double>() - scene.position.cast<double>()).norm(),
              1e-5);
    EXPECT_LT((tilted->linear() * model.normal.cast<double>() - scene.normal.cast<double>()).norm(),
              1e-5);
    // The shortest way.
    EXPECT_NEAR(Eigen::AngleAxisd(tilted->linear() * upright.linear().transpose()).angle(), angle,
                1e-5);
  }
  EXPECT_GT(tilted_poses, 50);
}

}  // namespace
}  // namespace rimod
