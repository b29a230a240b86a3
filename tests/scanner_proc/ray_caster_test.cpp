#include "scanner_proc/ray_caster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scanner_proc/curved_shapes.h"

namespace rimod::simulation {
namespace {

SceneObject MakeObject(Shape shape, const Eigen::Isometry3d& T_scene_object) {
  Part part;
  part.shape = std::move(shape);
  SceneObject object;
  object.T_scene_object = T_scene_object;
  object.parts.push_back(std::move(part));
  return object;
}

Eigen::Isometry3d At(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

TEST(RayCasterTest, RangeToABoxIsExactFarAway) {
  const RayCaster caster({MakeObject(BoxShape{{2, 2, 2}}, At(50, 0, -1))});
  for (const double angle : {0.0, 0.003, -0.0071, 0.0123}) {
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0);
    const auto hit = caster.Cast({Eigen::Vector3d::Zero(), direction}, 100.0);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->range, 49.0 / std::cos(angle), 1e-12);
    EXPECT_NEAR(hit->cos_incidence, std::cos(angle), 1e-12);
  }
}

TEST(RayCasterTest, RangeToASphereFollowsTheFormula) {
  const Eigen::Vector3d centre(3.0, 0.5, 0.8);
  const double radius = 0.6;
  const RayCaster caster({MakeObject(SphereShape{radius}, At(3.0, 0.5, 0.8 - radius))});
  std::mt19937 random(2);
  std::uniform_real_distribution<double> offset(-0.3, 0.3);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d direction =
        (centre + Eigen::Vector3d(offset(random), offset(random), offset(random))).normalized();
    const double along = centre.dot(direction);
    const double off_sq = centre.squaredNorm() - along * along;
    const auto hit = caster.Cast({Eigen::Vector3d::Zero(), direction}, 100.0);
    ASSERT_TRUE(hit);
    const double expected = along - std::sqrt(radius * radius - off_sq);
    EXPECT_NEAR(hit->range, expected, 1e-11);
    const Eigen::Vector3d normal = (expected * direction - centre) / radius;
    EXPECT_NEAR(hit->cos_incidence, -normal.dot(direction), 1e-9);
  }
}

TEST(RayCasterTest, TurnedPartsAreHitAsInTheirOwnFrame) {
  Eigen::Isometry3d T = At(4, -1, 0.5);
  T.rotate(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized()));
  const FrustumShape frustum{0.7, 0.2, 1.3};
  const RayCaster caster({MakeObject(frustum, T)});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> offset(-1.0, 1.0);
  int num_hits = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d target =
        T * Eigen::Vector3d(offset(random), offset(random), 0.65 + offset(random));
    const Eigen::Vector3d direction = target.normalized();
    const auto hit = caster.Cast({Eigen::Vector3d::Zero(), direction}, 100.0);
    const auto expected = Intersect(frustum, T.inverse() * Eigen::Vector3d::Zero(),
                                    T.linear().transpose() * direction, 0.001, 100.0);
    ASSERT_EQ(hit.has_value(), expected.has_value());
    if (!hit) continue;
    ++num_hits;
    EXPECT_NEAR(hit->range, expected->range, 1e-9);
  }
  EXPECT_GT(num_hits, 100);
}

TEST(RayCasterTest, TheNearestObjectIsHit) {
  const RayCaster caster({MakeObject(BoxShape{{0.1, 5, 5}}, At(4, 0, -2)),
                          MakeObject(SphereShape{0.5}, At(2, 0, -0.5)),
                          MakeObject(RectangleShape{{1, 1}}, At(0, 0, -1))});
  const auto sphere = caster.Cast({Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()}, 100.0);
  ASSERT_TRUE(sphere);
  EXPECT_EQ(sphere->object, 1u);
  EXPECT_NEAR(sphere->range, 1.5, 1e-12);
  const auto wall =
      caster.Cast({Eigen::Vector3d::Zero(), Eigen::Vector3d(1, 0.6, 0).normalized()}, 100.0);
  ASSERT_TRUE(wall);
  EXPECT_EQ(wall->object, 0u);
  const auto floor = caster.Cast({Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitZ()}, 100.0);
  ASSERT_TRUE(floor);
  EXPECT_EQ(floor->object, 2u);
  EXPECT_NEAR(floor->range, 1.0, 1e-12);
}

TEST(RayCasterTest, NothingBeyondTheRangeOrBehindIsHit) {
  const RayCaster caster({MakeObject(BoxShape{{2, 2, 2}}, At(10, 0, -1))});
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  EXPECT_FALSE(caster.Cast({origin, Eigen::Vector3d::UnitX()}, 8.9));
  EXPECT_TRUE(caster.Cast({origin, Eigen::Vector3d::UnitX()}, 9.1));
  EXPECT_FALSE(caster.Cast({origin, -Eigen::Vector3d::UnitX()}, 100.0));
  EXPECT_FALSE(caster.Cast({origin, Eigen::Vector3d::UnitY()}, 100.0));
}

TEST(RayCasterTest, MeshesAreSeenFromBothSides) {
  Mesh mesh;
  mesh.vertices = {{0, -1, -1}, {0, 1, -1}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}};
  const RayCaster caster({MakeObject(MeshShape{std::make_shared<const Mesh>(mesh)}, At(2, 0, 0))});
  EXPECT_NEAR(caster.Cast({{0, 0, 0}, {1, 0, 0}}, 100.0)->range, 2.0, 1e-12);
  EXPECT_NEAR(caster.Cast({{5, 0, 0}, {-1, 0, 0}}, 100.0)->range, 3.0, 1e-12);
}

TEST(RayCasterTest, AnEmptySceneGivesNothing) {
  const RayCaster caster({});
  EXPECT_FALSE(caster.Cast({Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()}, 100.0));
}

TEST(SceneTest, BoundingBoxHoldsEveryPartTightly) {
  SceneObject object = MakeObject(FrustumShape{0.5, 0.5, 2.0}, Eigen::Isometry3d::Identity());
  // Lying along x: from x = 0 to 2, half a metre round it.
  object.parts[0].T_object_part.rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()));
  Part ball;
  ball.shape = SphereShape{0.25};
  ball.T_object_part.translation() = Eigen::Vector3d(3, 1, 1);
  object.parts.push_back(ball);
  const Eigen::AlignedBox3d box = BoundingBox(object);
  EXPECT_LT((box.min() - Eigen::Vector3d(0, -0.5, -0.5)).norm(), 1e-12);
  EXPECT_LT((box.max() - Eigen::Vector3d(3.25, 1.25, 1.5)).norm(), 1e-12);
}

TEST(SceneTest, ObjectFrameIsAtTheMiddleOfTheBottom) {
  SceneObject object = MakeObject(BoxShape{{1, 2, 3}}, At(5, 6, 7));
  object.T_scene_object.rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  object.parts[0].T_object_part.translation() = Eigen::Vector3d(0.5, 0, 0.25);
  const ObjectFrame frame = ObjectFrameOf(object);
  EXPECT_LT((frame.T_scene_object.translation() - Eigen::Vector3d(5, 6.5, 7.25)).norm(), 1e-12);
  EXPECT_LT((frame.box.min() - Eigen::Vector3d(-0.5, -1, 0)).norm(), 1e-12);
  EXPECT_LT((frame.box.max() - Eigen::Vector3d(0.5, 1, 3)).norm(), 1e-12);
}

}  // namespace
}  // namespace rimod::simulation
