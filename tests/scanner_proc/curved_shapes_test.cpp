#include "scanner_proc/curved_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace rimod::simulation {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// How far a point lies off the surface, measured along no particular direction.
double OffSphere(const SphereShape& sphere, const Eigen::Vector3d& point) {
  return std::abs((point - Eigen::Vector3d(0, 0, sphere.radius)).norm() - sphere.radius);
}

double OffFrustum(const FrustumShape& frustum, const Eigen::Vector3d& point) {
  const double share = point.z() / frustum.height;
  const double radius =
      frustum.bottom_radius + share * (frustum.top_radius - frustum.bottom_radius);
  const double off_mantle = std::abs(point.head<2>().norm() - radius);
  const double off_bottom = std::abs(point.z());
  const double off_top = std::abs(point.z() - frustum.height);
  if (point.z() < -1e-9 || point.z() > frustum.height + 1e-9) return 1.0;
  if (off_bottom < 1e-9 && point.head<2>().norm() < frustum.bottom_radius + 1e-9) return off_bottom;
  if (off_top < 1e-9 && point.head<2>().norm() < frustum.top_radius + 1e-9) return off_top;
  return off_mantle;
}

bool InsideSphere(const SphereShape& sphere, const Eigen::Vector3d& point) {
  return (point - Eigen::Vector3d(0, 0, sphere.radius)).norm() < sphere.radius;
}

bool InsideFrustum(const FrustumShape& frustum, const Eigen::Vector3d& point) {
  const double share = point.z() / frustum.height;
  const double radius =
      frustum.bottom_radius + share * (frustum.top_radius - frustum.bottom_radius);
  return point.z() > 0 && point.z() < frustum.height && point.head<2>().norm() < radius;
}

// Walks along random rays in small steps: the ray must change sides where Intersect says, and
// nowhere before.
template <typename Shape, typename Inside, typename Off>
void ExpectMatchesMarching(const Shape& shape, Inside inside, Off off) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
  int num_hits = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d origin(coordinate(random), coordinate(random), coordinate(random));
    const Eigen::Vector3d target(coordinate(random), coordinate(random), coordinate(random));
    const Eigen::Vector3d direction =
        (0.6 * target + Eigen::Vector3d(0, 0, 0.5) - origin).normalized();
    const auto hit = Intersect(shape, origin, direction, 0.0, kFar);
    constexpr double kStep = 1e-3;
    const double end = hit ? hit->range - kStep : 6.0;
    const bool side = inside(shape, origin);
    for (double range = kStep; range < end; range += kStep) {
      ASSERT_EQ(inside(shape, origin + range * direction), side) << "ray " << i << " at " << range;
    }
    if (!hit) continue;
    ++num_hits;
    EXPECT_LT(off(shape, origin + hit->range * direction), 1e-9);
    EXPECT_GT(hit->normal.norm(), 0.0);
  }
  EXPECT_GT(num_hits, 50);
}

TEST(CurvedShapesTest, SphereIsHitWhereAMarchingRayEntersOrLeavesIt) {
  ExpectMatchesMarching(SphereShape{0.7}, InsideSphere, OffSphere);
}

TEST(CurvedShapesTest, CylinderIsHitWhereAMarchingRayEntersOrLeavesIt) {
  ExpectMatchesMarching(FrustumShape{0.5, 0.5, 0.9}, InsideFrustum, OffFrustum);
}

TEST(CurvedShapesTest, FrustumAndConesAreHitWhereAMarchingRayEntersOrLeavesThem) {
  ExpectMatchesMarching(FrustumShape{0.8, 0.3, 0.9}, InsideFrustum, OffFrustum);
  ExpectMatchesMarching(FrustumShape{0.0, 0.8, 1.1}, InsideFrustum, OffFrustum);
  ExpectMatchesMarching(FrustumShape{0.9, 0.0, 0.7}, InsideFrustum, OffFrustum);
}

TEST(CurvedShapesTest, NormalsAreOrthogonalToTheSurface) {
  const auto side = Intersect(FrustumShape{1.0, 0.0, 1.0}, {-3, 0, 0.5}, {1, 0, 0}, 0.0, kFar);
  ASSERT_TRUE(side);
  EXPECT_DOUBLE_EQ(side->range, 2.5);
  // The mantle of this cone falls at 45 degrees.
  EXPECT_NEAR(side->normal.normalized().x(), -std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(side->normal.normalized().z(), std::sqrt(0.5), 1e-12);
  const auto top = Intersect(FrustumShape{1.0, 0.5, 1.0}, {0.2, 0, 5}, {0, 0, -1}, 0.0, kFar);
  ASSERT_TRUE(top);
  EXPECT_DOUBLE_EQ(top->range, 4.0);
  EXPECT_NEAR(std::abs(top->normal.normalized().z()), 1.0, 1e-12);
}

TEST(CurvedShapesTest, OnlyRangesWithinTheLimitsCount) {
  const SphereShape sphere{1.0};
  const Eigen::Vector3d origin(-5, 0, 1);
  const Eigen::Vector3d direction(1, 0, 0);
  EXPECT_DOUBLE_EQ(Intersect(sphere, origin, direction, 0.0, kFar)->range, 4.0);
  EXPECT_DOUBLE_EQ(Intersect(sphere, origin, direction, 4.5, kFar)->range, 6.0);
  EXPECT_FALSE(Intersect(sphere, origin, direction, 0.0, 3.9));
  EXPECT_FALSE(Intersect(sphere, origin, direction, 6.1, kFar));
}

TEST(CurvedShapesTest, RaysAlongTheAxisHitTheLids) {
  const auto hit = Intersect(FrustumShape{0.5, 0.5, 2.0}, {0, 0, -1}, {0, 0, 1}, 0.0, kFar);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->range, 1.0);
  EXPECT_FALSE(Intersect(FrustumShape{0.5, 0.5, 2.0}, {0.6, 0, -1}, {0, 0, 1}, 0.0, kFar));
}

}  // namespace
}  // namespace rimod::simulation
