#include "rimod/surface_rendering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/io/random_values.h"
#include "tests/support/ray_caster.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

PixelGrid Grid(double resolution = 0.005, int width = 300, int height = 200) {
  PixelGrid grid;
  grid.width = width;
  grid.height = height;
  grid.resolution = resolution;
  grid.left = 0.5 * width * resolution;
  grid.top = 0.5 * height * resolution;
  return grid;
}

// Range of the world's surface in each pixel that the rendering covers, or beside it.
double TrueRange(const World& world, const PixelGrid& grid, int row, int column) {
  return CastBeam(world, Eigen::Vector3d::Zero(),
                  UnitVector(PixelDirection(grid, row + 0.5, column + 0.5)))
      .value_or(-1.0);
}

// The rendering as an image over the whole grid; 0 where nothing is seen.
double RangeInGrid(const RenderedModel& rendered, int row, int column) {
  const int r = row - rendered.first_row, c = column - rendered.first_column;
  if (r < 0 || c < 0 || r >= rendered.height || c >= rendered.width) return 0.0;
  return rendered.point(r, c) >= 0 ? rendered.range(r, c) : 0.0;
}

struct Comparison {
  int both = 0;     // pixels seen in truth and rendered
  int missing = 0;  // seen in truth only
  int excess = 0;   // rendered only
  double worst = 0.0;
  double mean = 0.0;
};

Comparison Compare(const RenderedModel& rendered, const World& world, const PixelGrid& grid) {
  Comparison result;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const double truth = TrueRange(world, grid, row, column);
      const double range = RangeInGrid(rendered, row, column);
      if (truth > 0.0 && range > 0.0) {
        const double error = std::abs(truth - range);
        result.worst = std::max(result.worst, error);
        result.mean += error;
        ++result.both;
      } else {
        result.missing += truth > 0.0;
        result.excess += range > 0.0;
      }
    }
  }
  result.mean /= std::max(result.both, 1);
  return result;
}

// A plate that is turned by heading and tilt out of facing the sensor.
Eigen::Isometry3d FacingPose(double distance, double heading, double tilt) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(M_PI + heading, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()))
                   .toRotationMatrix();
  T.translation() = Eigen::Vector3d(distance, 0.1, -0.2);
  return T;
}

TEST(RenderModelTest, APlaneHasItsExactDepth) {
  const ObjectModel plate = PlateModel("plate", 0.6, 0.01);
  const PixelGrid grid = Grid();
  for (const auto& [heading, tilt] : {std::pair{0.0, 0.0}, {0.7, 0.0}, {-0.9, 0.3}, {0.2, -0.5}}) {
    const Eigen::Isometry3d T = FacingPose(2.0, heading, tilt);
    World world;  // the plate as a very thin box
    BoxShape box;
    box.half_size = Eigen::Vector3d(1e-6, 0.3, 0.3);
    box.T_local_box = T * Eigen::Translation3d(0, 0, 0.3);
    world.boxes = {box};
    const Comparison result = Compare(RenderModel(plate, T, grid), world, grid);
    EXPECT_GT(result.both, 1000);
    EXPECT_LT(result.worst, 0.001) << heading << ' ' << tilt;
    EXPECT_EQ(result.missing, 0);
    EXPECT_LT(result.excess, result.both / 5);  // a rim of at most a disc and a pixel
  }
}

TEST(RenderModelTest, ASphereHasItsDepth) {
  const ObjectModel sphere = SphereModel("ball", 0.4, 0.01);
  const PixelGrid grid = Grid();
  const Eigen::Isometry3d T = Placed(2.0, 0.05, -0.3, 0.4);
  World world;
  world.spheres = {{Eigen::Vector3d(2.0, 0.05, 0.1), 0.4}};
  const Comparison result = Compare(RenderModel(sphere, T, grid), world, grid);
  EXPECT_GT(result.both, 3000);
  EXPECT_LT(result.mean, 0.002);
  EXPECT_LT(result.missing, result.both / 50);  // only the rim that is seen at a flat angle
  EXPECT_LT(result.excess, result.both / 20);
}

TEST(RenderModelTest, SeenPointsBelongToTheRangesAndFaceTheSensor) {
  const ObjectModel box = BoxModel("box", {0.5, 0.3, 0.4}, 0.01);
  const Eigen::Isometry3d T = Placed(1.8, -0.1, -0.2, 0.6);
  const RenderedModel rendered = RenderModel(box, T, Grid());
  ASSERT_GT(rendered.CountSeen(), 1000);
  int seen = 0;
  for (int row = 0; row < rendered.height; ++row) {
    for (int column = 0; column < rendered.width; ++column) {
      const int index = rendered.point(row, column);
      EXPECT_EQ(index >= 0, rendered.range(row, column) > 0.0f);
      if (index < 0) continue;
      ++seen;
      const Eigen::Vector3d p = T * box.points[index].cast<double>();
      const Eigen::Vector3d normal = T.linear() * box.normals[index].cast<double>();
      EXPECT_LT(normal.dot(p), 0.0);
      EXPECT_NEAR(rendered.range(row, column), p.norm(), 2.0 * box.point_spacing + 1e-6);
    }
  }
  EXPECT_EQ(rendered.CountSeen(), seen);
}

TEST(RenderModelTest, TheNearerSurfaceIsSeenWhateverTheOrder) {
  ObjectModel near_first = PlateModel("two", 0.5, 0.01);
  const std::size_t count = near_first.points.size();
  for (std::size_t i = 0; i < count; ++i) {
    near_first.points.push_back(near_first.points[i] - Eigen::Vector3f(0.3f, 0, 0));
    near_first.normals.push_back(near_first.normals[i]);
  }
  ObjectModel far_first = near_first;
  std::reverse(far_first.points.begin(), far_first.points.end());
  const Eigen::Isometry3d T = FacingPose(2.0, 0.0, 0.0);  // the far plate stands at 2.3 m
  for (const ObjectModel& model : {near_first, far_first}) {
    const RenderedModel rendered = RenderModel(model, T, Grid());
    for (int row = -10; row <= 10; ++row)
      for (int column = -10; column <= 10; ++column)
        EXPECT_LT(RangeInGrid(rendered, 100 + row, 150 + column), 2.05);
  }
}

TEST(RenderModelTest, BackFacesAreNotSeen) {
  const ObjectModel plate = PlateModel("plate", 0.6, 0.01);
  Eigen::Isometry3d T = FacingPose(2.0, 0.0, 0.0);
  T.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(RenderModel(plate, T, Grid()).CountSeen(), 0);
  T.rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));  // edge on
  T.translation().y() = 0.0;
  EXPECT_EQ(RenderModel(plate, T, Grid()).CountSeen(), 0);
}

TEST(RenderModelTest, OnlyThePartInsideTheGridIsRendered) {
  const ObjectModel plate = PlateModel("plate", 0.6, 0.01);
  const Eigen::Isometry3d T = FacingPose(2.0, 0.0, 0.0);
  const RenderedModel whole = RenderModel(plate, T, Grid());
  const PixelGrid small = Grid(0.005, 40, 20);
  const RenderedModel part = RenderModel(plate, T, small);
  EXPECT_EQ(part.CountSeen(), 800);
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 40; ++column)
      EXPECT_NEAR(RangeInGrid(part, row, column), RangeInGrid(whole, row + 90, column + 130), 1e-6);
}

TEST(RenderModelTest, NothingOfTheModelInTheGridIsNothing) {
  const ObjectModel plate = PlateModel("plate", 0.6, 0.01);
  for (const Eigen::Isometry3d& T :
       {FacingPose(-2.0, 0.0, 0.0), FacingPose(2.0, M_PI, 0.0), Placed(2, 40, 0, -M_PI / 2)}) {
    const RenderedModel rendered = RenderModel(plate, T, Grid());
    EXPECT_EQ(rendered.CountSeen(), 0);
    EXPECT_EQ(rendered.ranges.size(), rendered.points.size());
  }
  EXPECT_EQ(RenderModel(ObjectModel{}, FacingPose(2, 0, 0), Grid()).CountSeen(), 0);
  EXPECT_EQ(RenderModel(plate, FacingPose(2, 0, 0), PixelGrid{}).CountSeen(), 0);
}

TEST(RenderModelTest, ASensorAmidTheModelIsHarmless) {
  ObjectModel box = BoxModel("box", {0.5, 0.5, 0.5}, 0.02);
  for (Eigen::Vector3f& normal : box.normals) normal = -normal;  // seen from inside
  box.points.push_back({0.0f, 0.0f, 0.25f});                     // at the sensor itself
  box.normals.push_back({1.0f, 0.0f, 0.0f});
  const RenderedModel rendered = RenderModel(box, Placed(0, 0, -0.25, 0), Grid());
  EXPECT_GT(rendered.CountSeen(), 0);
  for (const float range : rendered.ranges) EXPECT_TRUE(std::isfinite(range) && range >= 0.0f);
}

}  // namespace
}  // namespace rimod
