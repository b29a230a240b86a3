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

PixelGrid Grid(int width, int height, double azimuth_left, double elevation_top) {
  PixelGrid grid;
  grid.resolution = 0.00698;
  grid.width = width;
  grid.height = height;
  grid.left = azimuth_left;
  grid.top = elevation_top;
  return grid;
}

ProjectedPoints Projected(const Scene& scene, const std::vector<Eigen::Vector3f>& points,
                          const Eigen::Isometry3f& pose, std::size_t begin = 0) {
  ProjectedPoints projected;
  scene.Project(PointColumns(points), pose, begin, points.size(), &projected);
  return projected;
}

TEST(SceneTest, ItsFastProjectionAgreesWithTheExactOne) {
  RandomValues random(2);
  const PixelGrid grid = Grid(900, 440, 3.1415, 1.55);
  const Scene scene(RangeImage(grid, Eigen::Isometry3d::Identity()), 0.1, Execution{});
  const Eigen::Isometry3d pose = random.Pose();
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 20003; ++i)
    points.push_back(
        (pose.inverse() * (random.Between(0.1, 80.0) * random.Unit())).eval().cast<float>());
  const ProjectedPoints projected = Projected(scene, points, pose.cast<float>());
  int inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = pose * points[i].cast<double>();
    // Floats leave an error of a millionth of the pose's distance, which may be large beside p.
    constexpr double kNear = 2.0;  // m
    if (p.norm() < kNear) continue;
    EXPECT_NEAR(projected.ranges[i], p.norm(), 1e-5 * p.norm() + 1e-5);
    const PixelPosition exact = Project(grid, p);
    const double row_rest = exact.row - std::floor(exact.row);
    const double column_rest = exact.column - std::floor(exact.column);
    const bool at_an_edge = std::min({row_rest, 1 - row_rest, column_rest, 1 - column_rest}) < 0.02;
    const bool near_the_pole = std::hypot(p.x(), p.y()) < 0.05 * p.norm();
    if (at_an_edge || near_the_pole) continue;
    const int row = static_cast<int>(std::floor(exact.row));
    const int column = static_cast<int>(std::floor(exact.column));
    const int expected = grid.Contains(row, column) ? row * grid.width + column : -1;
    ASSERT_EQ(projected.pixels[i], expected) << p.transpose();
    inside += expected >= 0;
  }
  EXPECT_GT(inside, 10000);
}

TEST(SceneTest, APartOfThePointsFallsAsAllDo) {
  RandomValues random(5);
  const Scene scene(RangeImage(Grid(300, 120, 1.5, 0.6), Eigen::Isometry3d::Identity()), 0.1,
                    Execution{});
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 103; ++i) points.push_back(random.Vector(3.0).cast<float>());
  const Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
  const ProjectedPoints all = Projected(scene, points, pose);
  const ProjectedPoints part = Projected(scene, points, pose, 5);
  ASSERT_EQ(part.pixels.size(), points.size());
  for (std::size_t i = 5; i < points.size(); ++i) {
    EXPECT_EQ(part.pixels[i], all.pixels[i]);
    EXPECT_EQ(part.ranges[i], all.ranges[i]);
  }
}

TEST(SceneTest, WhatIsNoPointIsOutside) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  const std::vector<Eigen::Vector3f> points = {
      {nan, 0, 0}, {nan, nan, nan}, {1, nan, 0}, {infinite, 0, 0}, {-infinite, infinite, 0}};
  const Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
  const Scene scene(RandomValues(3).AnImage(10, 10), 0.1, Execution{});
  for (const std::size_t i : {0, 1, 2, 4}) EXPECT_EQ(Projected(scene, points, pose).pixels[i], -1);
  const Scene empty(RangeImage(), 0.1, Execution{});
  EXPECT_EQ(Projected(empty, {{1, 0, 0}}, pose).pixels[0], -1);
}

TEST(SceneTest, TheNearestPixelIsThatOfTheNine) {
  RandomValues random(6);
  const int width = 30, height = 20;
  const RangeImage image = random.AnImage(width, height);
  const Scene scene(image, 0.1, Execution{});
  int found = 0, at_the_edge = 0;
  for (int i = 0; i < 20000; ++i) {
    const int row = random.Int(0, height - 1), column = random.Int(0, width - 1);
    const Eigen::Vector3f p = image.point(row, column) + random.Vector(1.0).cast<float>();
    const float gate = static_cast<float>(random.Between(0.05, 30.0));
    int expected = -1;
    float nearest = gate;
    for (int r = row - 1; r <= row + 1; ++r) {
      for (int c = column - 1; c <= column + 1; ++c) {
        if (!image.grid().Contains(r, c) || !image.measured(r, c)) continue;
        const float distance = (image.point(r, c) - p).norm();
        if (distance >= nearest) continue;
        nearest = distance;
        expected = r * width + c;
      }
    }
    ASSERT_EQ(scene.NearestPixel(row * width + column, p, gate), expected);
    found += expected >= 0;
    at_the_edge += expected >= 0 && (row == 0 || column == 0 || row == height - 1);
  }
  EXPECT_GT(found, 5000);
  EXPECT_LT(found, 19000);
  EXPECT_GT(at_the_edge, 500);
}

TEST(SceneTest, NothingIsNearestWhereNothingIsMeasured) {
  RangeImage image(Grid(5, 5, 0.0, 0.0), Eigen::Isometry3d::Identity());
  image.SetNoReturn(2, 2);
  const Scene scene(image, 0.1, Execution{});
  EXPECT_EQ(scene.NearestPixel(12, Eigen::Vector3f(1, 0, 0), 1e6f), -1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  image.SetMeasured(2, 2, {1600, 0, 0});
  const Scene one(image, 0.1, Execution{});
  EXPECT_EQ(one.NearestPixel(0, image.point(2, 2), 1.0f), -1);
  EXPECT_EQ(one.NearestPixel(6, image.point(2, 2), 1.0f), 12);
  EXPECT_EQ(one.NearestPixel(12, Eigen::Vector3f(nan, 0, 0), 1.0f), -1);
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
