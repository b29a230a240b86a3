#include "rimod/range_patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "rimod/descriptor_index.h"
#include "tests/io/random_values.h"
#include "tests/support/ray_caster.h"

namespace rimod {
namespace {

RangePatchParams Params() {
  RangePatchParams params;
  params.resolution = 8;
  params.support_size = 0.4;  // cells of 5 cm
  params.normal_radius = 0.06;
  params.min_points = 8;
  params.mask_empty_cells = true;
  params.max_vertical_cosine = 0.966;
  return params;
}

// A level sensor at the origin of the local frame.
RangeImage See(const World& world, const BeamPattern& pattern = {}) {
  RangeImageParams params;
  params.resolution = pattern.step;
  return MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), pattern), params);
}

// A fine grid of beams around straight ahead.
BeamPattern Ahead() {
  BeamPattern pattern;
  pattern.azimuth_min = pattern.elevation_min = -0.25;
  pattern.azimuth_max = pattern.elevation_max = 0.25;
  pattern.step = 0.004;
  return pattern;
}

PixelIndex PixelOf(const RangeImage& image, const Eigen::Vector3d& p_sensor) {
  const PixelPosition position = Project(image.grid(), p_sensor);
  return {static_cast<int>(std::floor(position.row)),
          static_cast<int>(std::floor(position.column))};
}

World PlaneThrough(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  World world;
  world.planes = {{point, normal.normalized()}};
  return world;
}

TEST(NormalAtTest, IsThatOfAPlaneTowardsTheSensor) {
  RandomValues random(1);
  for (int i = 0; i < 30; ++i) {
    Eigen::Vector3d normal = random.Unit();
    if (std::abs(normal.x()) < 0.4) continue;  // seen too flat
    const RangeImage image = See(PlaneThrough({2, 0, 0}, normal), Ahead());
    const std::optional<Eigen::Vector3d> found = NormalAt(image, PixelOf(image, {2, 0, 0}), 0.1, 8);
    ASSERT_TRUE(found);
    if (normal.x() > 0) normal = -normal;
    EXPECT_GT(found->dot(normal), 0.9995) << normal.transpose();
    EXPECT_NEAR(found->norm(), 1.0, 1e-9);
  }
}

TEST(NormalAtTest, IsThatOfASphere) {
  World world;
  world.spheres = {{Eigen::Vector3d(2.0, 0.0, 0.0), 0.4}};
  const RangeImage image = See(world, Ahead());
  for (const Eigen::Vector3d& outward :
       {Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(-1, 0.4, 0), Eigen::Vector3d(-1, 0.2, -0.4)}) {
    const Eigen::Vector3d p = world.spheres[0].centre + 0.4 * outward.normalized();
    const std::optional<Eigen::Vector3d> found = NormalAt(image, PixelOf(image, p), 0.06, 8);
    ASSERT_TRUE(found);
    EXPECT_GT(found->dot(outward.normalized()), 0.998);
  }
}

TEST(NormalAtTest, NeedsEnoughPointsThatAreNoLine) {
  PixelGrid grid;
  grid.width = grid.height = 30;
  grid.resolution = 0.005;
  grid.left = grid.top = 0.075;
  const RoundedPixel at_two_metres{1600, 0, 0};
  RangeImage image(grid, Eigen::Isometry3d::Identity());
  image.SetMeasured(15, 15, at_two_metres);
  EXPECT_FALSE(NormalAt(image, {15, 15}, 0.1, 3));  // alone
  for (int column = 5; column < 25; ++column) image.SetMeasured(15, column, at_two_metres);
  EXPECT_FALSE(NormalAt(image, {15, 15}, 0.1, 3));  // a line
  for (int column = 5; column < 25; ++column) image.SetMeasured(17, column, at_two_metres);
  EXPECT_TRUE(NormalAt(image, {15, 15}, 0.1, 3));
  EXPECT_FALSE(NormalAt(image, {15, 15}, 0.1, 500));
  EXPECT_FALSE(NormalAt(image, {15, 15}, 0.001, 3));
}

TEST(PatchFrameTest, IsARightHandedFrameWithAHorizontalX) {
  RandomValues random(2);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d normal = random.Unit();
    const Eigen::Vector3d line_of_sight = random.Unit();
    const Eigen::Matrix3d frame = PatchFrame(normal, line_of_sight, 0.966);
    EXPECT_TRUE((frame.transpose() * frame).isIdentity(1e-9));
    EXPECT_NEAR(frame.determinant(), 1.0, 1e-9);
    EXPECT_NEAR((frame.col(2) - normal).norm(), 0.0, 1e-9);
    if (std::abs(normal.z()) < 0.96) {
      EXPECT_NEAR(frame(2, 0), 0.0, 1e-9);
      EXPECT_GT(frame(2, 1), 0.0);  // y upwards
    }
  }
}

TEST(PatchFrameTest, OfAFloorLiesAcrossTheLineOfSight) {
  RandomValues random(3);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d line_of_sight = random.Unit();
    if (line_of_sight.head<2>().norm() < 0.1) continue;
    const Eigen::Matrix3d frame = PatchFrame(Eigen::Vector3d::UnitZ(), line_of_sight, 0.966);
    EXPECT_NEAR(frame.col(0).dot(line_of_sight), 0.0, 1e-9);
    EXPECT_GT(frame.col(1).dot(line_of_sight), 0.0);  // y away from the viewer: x to the right
  }
}

TEST(PatchFrameTest, IsFiniteWhereNothingGivesADirection) {
  for (const double sign : {-1.0, 1.0}) {
    const Eigen::Vector3d up = sign * Eigen::Vector3d::UnitZ();
    const Eigen::Matrix3d frame = PatchFrame(up, Eigen::Vector3d::UnitZ(), 0.966);
    EXPECT_TRUE((frame.transpose() * frame).isIdentity(1e-9));
    EXPECT_TRUE(PatchFrame(up, Eigen::Vector3d::UnitZ(), 1.0).allFinite());
  }
}

TEST(DescribePatchTest, OfAPlaneIsFlat) {
  RandomValues random(4);
  for (int i = 0; i < 20; ++i) {
    Eigen::Vector3d normal = random.Unit();
    if (std::abs(normal.x()) < 0.6) continue;
    const RangeImage image = See(PlaneThrough({2, 0, 0}, normal), Ahead());
    const std::optional<Feature> feature =
        DescribePatch(image, PixelOf(image, {2, 0, 0}), Params());
    ASSERT_TRUE(feature);
    ASSERT_EQ(feature->descriptor.size(), 64u);
    for (const std::int16_t value : feature->descriptor) {
      ASSERT_NE(value, kEmptyCell);
      EXPECT_LE(std::abs(value), 40);  // 4 mm: the rounding of ranges tilts the normal a little
    }
  }
}

TEST(DescribePatchTest, OfAStepHasTheStepsHeights) {
  // A wall 2 m ahead, its left part (y > 0.025) 5 cm nearer. Seen from y = -0.1 the edge lies in
  // the middle of the patch's second column of cells, whose highest points are the step's.
  World world = PlaneThrough({2, 0, 0}, {1, 0, 0});
  BoxShape step;
  step.T_local_box = Placed(2.0, 0.025 + 1.0, 0.0, 0.0);
  step.half_size = Eigen::Vector3d(0.05, 1.0, 5.0);
  world.boxes = {step};
  const RangeImage image = See(world, Ahead());
  const std::optional<Feature> feature =
      DescribePatch(image, PixelOf(image, {2.0, -0.1, 0.0}), Params());
  ASSERT_TRUE(feature);
  EXPECT_LT(feature->normal.x(), -0.999f);
  // Columns 0 and 1 of 8 are 5 cm high: the mean is 1.25 cm.
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 8; ++column) {
      const double height = feature->descriptor[row * 8 + column] * kDescriptorUnit;
      EXPECT_NEAR(height, column < 2 ? 0.0375 : -0.0125, 0.004) << row << ' ' << column;
    }
  }
}

TEST(DescribePatchTest, RowsFallFromTheTop) {
  // The upper part of the wall is nearer.
  World world = PlaneThrough({2, 0, 0}, {1, 0, 0});
  BoxShape step;
  step.T_local_box = Placed(2.0, 0.0, 0.125 + 1.0, 0.0);
  step.half_size = Eigen::Vector3d(0.05, 5.0, 1.0);
  world.boxes = {step};
  const RangeImage image = See(world, Ahead());
  const std::optional<Feature> feature =
      DescribePatch(image, PixelOf(image, {2.0, 0.0, 0.0}), Params());
  ASSERT_TRUE(feature);
  for (int column = 0; column < 8; ++column) {
    EXPECT_GT(feature->descriptor[column], 200);
    EXPECT_LT(feature->descriptor[7 * 8 + column], 0);
  }
}

TEST(DescribePatchTest, ItsMeanIsZeroOverTheFilledCells) {
  World world = PlaneThrough({2.5, 0, 0}, {1, 0.3, 0.1});
  world.spheres = {{Eigen::Vector3d(2.0, 0.1, 0.0), 0.2}};
  const RangeImage image = See(world, Ahead());
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(2, 0, 0.03), Eigen::Vector3d(2, -0.1, -0.1)}) {
    const std::optional<Feature> feature = DescribePatch(image, PixelOf(image, p), Params());
    ASSERT_TRUE(feature);
    double sum = 0.0;
    int filled = 0;
    for (const std::int16_t value : feature->descriptor) {
      if (value == kEmptyCell) continue;
      sum += value;
      ++filled;
    }
    EXPECT_LE(std::abs(sum), 0.5 * filled + 1e-9);  // half a step of rounding each
  }
}

TEST(DescribePatchTest, EmptyCellsAreMaskedOrAtTheMean) {
  World world;  // a ball alone: the patch reaches past its rim
  world.spheres = {{Eigen::Vector3d(2.0, 0.0, 0.0), 0.1}};
  const RangeImage image = See(world, Ahead());
  const PixelIndex pixel = PixelOf(image, {1.9, 0, 0});
  RangePatchParams params = Params();
  const std::optional<Feature> masked = DescribePatch(image, pixel, params);
  params.mask_empty_cells = false;
  const std::optional<Feature> filled = DescribePatch(image, pixel, params);
  ASSERT_TRUE(masked && filled);
  EXPECT_EQ(masked->descriptor[0], kEmptyCell);  // a corner, 28 cm from the ball's middle
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_NE(filled->descriptor[i], kEmptyCell);
    EXPECT_EQ(filled->descriptor[i],
              masked->descriptor[i] == kEmptyCell ? 0 : masked->descriptor[i]);
  }
}

// The features of one scene, seen from one place relative to it, wherever that scene stands.
TEST(DescribePatchTest, IsTheSameWhenSceneAndSensorMoveTogether) {
  World world = PlaneThrough({2.5, 0, 0}, {1, 0.2, 0.0});
  world.spheres = {{Eigen::Vector3d(2.0, 0.2, 0.1), 0.15}};
  BoxShape box;
  box.T_local_box = Placed(2.1, -0.2, 0.0, 0.5);
  box.half_size = Eigen::Vector3d(0.15, 0.1, 0.2);
  world.boxes = {box};
  const Scan scan = ScanWorld(world, Eigen::Isometry3d::Identity(), Ahead());
  RangeImageParams image_params;
  image_params.resolution = Ahead().step;
  const RangeImage image = MakeRangeImage(scan, image_params);

  RandomValues random(5);
  const Eigen::Isometry3d T = random.Level();
  Scan moved;
  moved.T_local_sensor = T;
  for (const Eigen::Vector3f& p : scan.points)
    moved.points.push_back((T * p.cast<double>()).cast<float>());
  const RangeImage moved_image = MakeRangeImage(moved, image_params);

  int compared = 0, equal = 0;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d direction =
        UnitVector({random.Between(-0.2, 0.2), random.Between(-0.2, 0.2)});
    const PixelIndex pixel = PixelOf(image, direction);
    const PixelIndex moved_pixel = PixelOf(moved_image, direction);
    if (!image.measured(pixel.row, pixel.column) ||
        !moved_image.measured(moved_pixel.row, moved_pixel.column))
      continue;
    const std::optional<Feature> a = DescribePatch(image, pixel, Params());
    const std::optional<Feature> b = DescribePatch(moved_image, moved_pixel, Params());
    ASSERT_TRUE(a && b);
    if ((a->position - b->position).norm() > 0.002f) continue;  // rounded into the next pixel
    ++compared;
    equal += DescriptorDistance(a->descriptor, b->descriptor, 1) < 0.003;
  }
  EXPECT_GE(compared, 60);
  EXPECT_GE(equal, compared * 9 / 10);  // at edges a rounded range may fill another cell
}

TEST(DescribePatchTest, NothingWithoutANormal) {
  PixelGrid grid;
  grid.width = grid.height = 9;
  grid.resolution = 0.01;
  RangeImage image(grid, Eigen::Isometry3d::Identity());
  image.SetMeasured(4, 4, {1600, 0, 0});
  EXPECT_FALSE(DescribePatch(image, {4, 4}, Params()));
}

TEST(DescribePatchTest, PointsRightBeforeTheSensorAreHarmless) {
  PixelGrid grid;
  grid.width = grid.height = 60;
  grid.resolution = 0.02;
  grid.left = grid.top = 0.6;
  RangeImage image(grid, Eigen::Isometry3d::Identity());
  for (int row = 0; row < 60; ++row)
    for (int column = 0; column < 60; ++column) image.SetMeasured(row, column, {1, 0, 0});
  const std::optional<Feature> feature = DescribePatch(image, {30, 30}, Params());
  EXPECT_TRUE(!feature || feature->normal.allFinite());
}

TEST(RangePatchParamsTest, KindNamesWhatTheDescriptorDependsOn) {
  const std::string kind = Params().Kind();
  EXPECT_EQ(Params().Kind(), kind);
  RangePatchParams params = Params();
  params.resolution = 9;
  EXPECT_NE(params.Kind(), kind);
  params = Params();
  params.support_size = 0.41;
  EXPECT_NE(params.Kind(), kind);
  params = Params();
  params.normal_radius = 0.07;
  EXPECT_NE(params.Kind(), kind);
  params = Params();
  params.mask_empty_cells = false;
  EXPECT_NE(params.Kind(), kind);
  params = Params();
  params.max_vertical_cosine = 0.9;
  EXPECT_NE(params.Kind(), kind);
}

}  // namespace
}  // namespace rimod
