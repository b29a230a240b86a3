#include "rimod/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/io/random_values.h"
#include "tests/support/executions.h"
#include "tests/support/ray_caster.h"

namespace rimod {
namespace {

RangeImage See(const World& world) {
  RangeImageParams params;
  params.resolution = 0.0069;
  return MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{}), params);
}

TEST(SceneTest, KeepsRangesAndKindsOfPixels) {
  const RangeImage image = RandomValues(1).AnImage(60, 40);
  const Scene scene(image, 0.1, Execution{});
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 60; ++column) {
      const int pixel = row * 60 + column;
      EXPECT_EQ(scene.point(pixel), image.point(row, column));
      switch (image.pixel(row, column)) {
        case Pixel::kMeasured:
          EXPECT_EQ(scene.range(pixel), image.range(row, column));
          break;
        case Pixel::kNoReturn:
          EXPECT_TRUE(std::isinf(scene.range(pixel)));
          break;
        case Pixel::kNeverObserved:
          EXPECT_EQ(scene.range(pixel), 0.0f);
      }
      const float length = scene.normal(pixel).norm();
      EXPECT_TRUE(length == 0.0f || std::abs(length - 1.0f) < 1e-4f);
      EXPECT_LE(scene.normal(pixel).dot(scene.point(pixel)), 1e-3f);
    }
  }
}

TEST(SceneTest, ItsFastProjectionAgreesWithTheExactOne) {
  RandomValues random(2);
  SphericalGrid grid;
  grid.resolution = 0.00698;
  grid.width = 900;
  grid.height = 440;
  grid.azimuth_left = 3.1415;
  grid.elevation_top = 1.55;
  const Scene scene(RangeImage(grid, Eigen::Isometry3d::Identity()), 0.1, Execution{});
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d p = random.Between(0.1, 80.0) * random.Unit();
    const PixelPosition exact = Project(grid, p);
    const double row_rest = exact.row - std::floor(exact.row);
    const double column_rest = exact.column - std::floor(exact.column);
    const bool at_an_edge = std::min({row_rest, 1 - row_rest, column_rest, 1 - column_rest}) < 0.01;
    if (at_an_edge) continue;
    const int row = static_cast<int>(std::floor(exact.row));
    const int column = static_cast<int>(std::floor(exact.column));
    const int expected = grid.Contains(row, column) ? row * grid.width + column : -1;
    ASSERT_EQ(scene.PixelOf(p.cast<float>()), expected) << p.transpose();
    inside += expected >= 0;
  }
  EXPECT_GT(inside, 10000);
}

TEST(SceneTest, WhatIsNoPointIsOutside) {
  const Scene scene(RandomValues(3).AnImage(10, 10), 0.1, Execution{});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(scene.PixelOf(nan, 0.0f, 0.0f), -1);
  EXPECT_EQ(scene.PixelOf(nan, nan, nan), -1);
  const Scene empty(RangeImage(), 0.1, Execution{});
  EXPECT_EQ(empty.PixelOf(1.0f, 0.0f, 0.0f), -1);
}

TEST(SceneTest, ManyPointsFallWhereEachOfThemFalls) {
  RandomValues random(5);
  SphericalGrid grid;
  grid.resolution = 0.01;
  grid.width = 300;
  grid.height = 120;
  grid.azimuth_left = 1.5;
  grid.elevation_top = 0.6;
  const Scene scene(RangeImage(grid, Eigen::Isometry3d::Identity()), 0.1, Execution{});
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 1003; ++i) points.push_back(random.Vector(3.0).cast<float>());
  points[7].setConstant(std::numeric_limits<float>::quiet_NaN());
  points[8].setZero();
  const Eigen::Isometry3f pose = random.Pose().cast<float>();
  ProjectedPoints projected;
  scene.Project(PointColumns(points), pose, 5, points.size(), &projected);
  ASSERT_EQ(projected.pixels.size(), points.size());
  int differing = 0, inside = 0;
  for (std::size_t i = 5; i < points.size(); ++i) {
    const Eigen::Vector3f p = pose * points[i];
    differing += projected.pixels[i] != scene.PixelOf(p);  // but for the last bit at a pixel's edge
    inside += projected.pixels[i] >= 0;
    if (i == 7) continue;
    EXPECT_NEAR(projected.ranges[i], p.norm(), 1e-5f * p.norm());
  }
  EXPECT_LE(differing, 3);
  EXPECT_GT(inside, 50);
  EXPECT_EQ(projected.pixels[7], -1);
}

TEST(SceneTest, NormalsAreThoseOfTheSurfaces) {
  World world;
  const Eigen::Vector3d wall_normal = Eigen::Vector3d(-1, 0.3, 0.2).normalized();
  world.planes = {{Eigen::Vector3d(3, 0, 0), wall_normal}};
  world.spheres = {{Eigen::Vector3d(2.0, 0.0, 0.0), 0.4}};
  const RangeImage image = See(world);
  const Scene scene(image, 0.06, Execution{});
  int on_sphere = 0, good_sphere = 0, on_wall = 0, good_wall = 0;
  for (int pixel = 0; pixel < image.grid().size(); ++pixel) {
    if (!(scene.range(pixel) > 0.0f) || std::isinf(scene.range(pixel))) continue;
    const Eigen::Vector3d p = scene.point(pixel).cast<double>();
    const Eigen::Vector3d n = scene.normal(pixel).cast<double>();
    const Eigen::Vector3d outward = p - world.spheres[0].centre;
    if (outward.norm() > 0.5) {
      ++on_wall;
      good_wall += n.dot(wall_normal) > 0.99;
    } else if (-outward.normalized().dot(p.normalized()) > 0.5) {
      ++on_sphere;
      good_sphere += n.dot(outward.normalized()) > 0.98;
    }
  }
  EXPECT_GT(on_sphere, 500);
  EXPECT_GT(good_sphere, on_sphere * 0.97);
  EXPECT_GT(good_wall, on_wall * 0.97);
}

TEST(SceneTest, ThreadsDoNotMatter) {
  const RangeImage image = RandomValues(4).AnImage(80, 60);
  const Scene alone(image, 0.2, Execution{}), other(image, 0.2, OnThreads(4));
  for (int pixel = 0; pixel < image.grid().size(); ++pixel)
    EXPECT_EQ(alone.normal(pixel), other.normal(pixel));
}

}  // namespace
}  // namespace rimod
