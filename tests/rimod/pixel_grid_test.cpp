#include "rimod/pixel_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/io/random_values.h"

namespace rimod {
namespace {

constexpr double kDegree = M_PI / 180.0;

PixelGrid SphericalGrid() {
  PixelGrid grid;
  grid.width = 200;
  grid.height = 160;
  grid.resolution = 0.007;
  grid.left = 0.8;
  grid.top = 0.6;
  return grid;
}

PixelGrid PinholeGrid(const Direction& axis) {
  PixelGrid grid = SphericalGrid();
  grid.projection = Projection::kPinhole;
  grid.axis = axis;
  return grid;
}

PixelGrid RandomPinholeGrid(RandomValues* random) {
  PixelGrid grid =
      PinholeGrid({random->Between(-M_PI, M_PI), random->Between(-M_PI / 2, M_PI / 2)});
  grid.resolution = random->Between(0.002, 0.02);
  grid.left = random->Between(-0.5, 1.5);
  grid.top = random->Between(-0.5, 1.5);
  return grid;
}

TEST(PixelGridTest, ProjectInvertsPixelBeamAndPixelDirection) {
  RandomValues random(1);
  for (int i = 0; i < 2000; ++i) {
    const PixelGrid grid = i % 2 == 0 ? SphericalGrid() : RandomPinholeGrid(&random);
    const double row = random.Between(0, 60), column = random.Between(0, 80);
    const Eigen::Vector3d beam = PixelBeam(grid, row, column);
    EXPECT_NEAR(beam.norm(), 1.0, 1e-12);
    EXPECT_NEAR((UnitVector(PixelDirection(grid, row, column)) - beam).norm(), 0.0, 1e-9);
    for (const PixelPosition& position : {Project(grid, random.Between(0.1, 80.0) * beam),
                                          ProjectDirection(grid, DirectionOf(beam))}) {
      EXPECT_NEAR(position.row, row, 1e-7);
      EXPECT_NEAR(position.column, column, 1e-7);
    }
  }
}

TEST(PixelGridTest, PixelBeamInvertsProject) {
  RandomValues random(2);
  int num_held = 0;
  for (int i = 0; i < 4000; ++i) {
    const PixelGrid grid = RandomPinholeGrid(&random);
    const Eigen::Vector3d beam = random.Unit();
    const bool near_axis = beam.dot(UnitVector(grid.axis)) > std::cos(75.0 * kDegree);
    ASSERT_EQ(CanHold(grid, 3.0 * beam), near_axis);
    const PixelPosition position = Project(grid, 3.0 * beam);
    if (!near_axis) {
      EXPECT_LT(position.row, -10.0);
      EXPECT_LT(position.column, -10.0);
      continue;
    }
    ++num_held;
    EXPECT_NEAR((PixelBeam(grid, position.row, position.column) - beam).norm(), 0.0, 1e-9);
  }
  EXPECT_GT(num_held, 1000);
}

TEST(PixelGridTest, APinholesImageIsUprightWithItsAxisWhereItsCoordinatesAreZero) {
  for (const double elevation_deg : {-90.0, -75.0, -15.0, 0.0, 40.0, 90.0}) {
    const PixelGrid grid = PinholeGrid({0.4, elevation_deg * kDegree});
    const Eigen::Vector3d along = UnitVector(grid.axis);
    const PixelPosition middle = Project(grid, 2.0 * along);
    EXPECT_NEAR(middle.row, grid.top / grid.resolution, 1e-9);
    EXPECT_NEAR(middle.column, grid.left / grid.resolution, 1e-9);
    // A row is level: its beams end at one height on a plane across the axis.
    const Eigen::Vector3d right = PixelBeam(grid, middle.row, middle.column + 30);
    EXPECT_NEAR(right.z() / right.dot(along), along.z(), 1e-9);
    const Eigen::Vector3d above = PixelBeam(grid, middle.row - 30, middle.column);
    if (std::abs(elevation_deg) < 90.0) {
      EXPECT_GT(above.z() / above.dot(along), along.z());
    }
  }
  // Straight down the right is where it is when looking ahead.
  const PixelGrid down = PinholeGrid({0.0, -M_PI / 2});
  EXPECT_LT(Project(down, {0, 0.1, -1}).column, Project(down, {0, -0.1, -1}).column);
  EXPECT_LT(Project(down, {0.1, 0, -1}).row, Project(down, {-0.1, 0, -1}).row);
}

TEST(PixelGridTest, WhatAPinholeCannotHoldIsFarOutsideAndFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  PixelGrid grid = PinholeGrid({0.0, 0.0});
  for (const double resolution : {1e-5, 0.007, 0.9}) {
    grid.resolution = resolution;
    for (const Eigen::Vector3d& p :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(-1e-300, 0, 0),
          Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(1e-12, 0, 1e9), Eigen::Vector3d(0.2, 1, 0),
          Eigen::Vector3d(nan, 0, 0), Eigen::Vector3d(1, nan, 0), Eigen::Vector3d(inf, 0, 0),
          Eigen::Vector3d(1, -inf, 0)}) {
      const PixelPosition position = Project(grid, p);
      for (const double value : {position.row, position.column}) {
        EXPECT_LT(value, -100.0) << p.transpose();
        EXPECT_GT(value, std::numeric_limits<int>::min()) << p.transpose();
      }
      EXPECT_FALSE(CanHold(grid, p));
    }
    EXPECT_NEAR(Project(grid, {1e15, 0, 0}).column, grid.left / resolution, 1e-6);
    EXPECT_NEAR(Project(grid, {1e-15, 0, 0}).row, grid.top / resolution, 1e-6);
  }
}

TEST(PixelGridTest, PixelAngleIsTheSpacingOfPointsOnTheSurface) {
  RandomValues random(3);
  for (int i = 0; i < 500; ++i) {
    const int row = random.Int(1, 60), column = random.Int(1, 80);
    const double r = row + 0.5, c = column + 0.5, range = random.Between(0.5, 10.0);
    // Pinhole: on the plane across the axis, in both directions.
    const PixelGrid pinhole = RandomPinholeGrid(&random);
    const Eigen::Vector3d along = UnitVector(pinhole.axis);
    const double depth = range * PixelBeam(pinhole, r, c).dot(along);
    const auto on_plane = [&](double at_row, double at_column) -> Eigen::Vector3d {
      const Eigen::Vector3d beam = PixelBeam(pinhole, at_row, at_column);
      return depth / beam.dot(along) * beam;
    };
    const double spacing = PixelAngle(pinhole, row, column) * range;
    EXPECT_NEAR((on_plane(r, c + 1) - on_plane(r, c)).norm(), spacing, 1e-9);
    EXPECT_NEAR((on_plane(r + 1, c) - on_plane(r, c)).norm(), spacing, 1e-9);
    EXPECT_NEAR(PixelAngle(pinhole, on_plane(r, c)), PixelAngle(pinhole, row, column), 1e-12);
    // Spherical: across the beams, from row to row.
    const PixelGrid spherical = SphericalGrid();
    const double chord =
        range * (PixelBeam(spherical, r + 1, c) - PixelBeam(spherical, r, c)).norm();
    EXPECT_NEAR(chord, PixelAngle(spherical, row, column) * range, 1e-5 * range);
  }
}

TEST(PixelGridTest, PinholeReachIsWhereTheBallEnds) {
  RandomValues random(4);
  for (int i = 0; i < 300; ++i) {
    PixelGrid grid = RandomPinholeGrid(&random);
    grid.width = grid.height = 100000;
    const double row = random.Between(0, 40), column = random.Between(0, 50);
    const Eigen::Vector3d centre = random.Between(0.5, 5.0) * PixelBeam(grid, row, column);
    const double sine = random.Between(0.001, 0.3);
    const PixelReach reach = PinholeReach(grid, CoordinatesAt(grid, row, column), sine);
    double rows = 0.0, columns = 0.0;
    for (int k = 0; k < 2000; ++k) {
      const PixelPosition at = Project(grid, centre + sine * centre.norm() * random.Unit());
      if (at.row < -1e4) continue;
      rows = std::max(rows, std::abs(at.row - row));
      columns = std::max(columns, std::abs(at.column - column));
    }
    EXPECT_LE(rows, reach.rows * (1 + 1e-9));
    EXPECT_LE(columns, reach.columns * (1 + 1e-9));
    if (reach.rows * grid.resolution < 1.0) {
      EXPECT_GT(rows, 0.8 * reach.rows);
    }
    if (reach.columns * grid.resolution < 1.0) {
      EXPECT_GT(columns, 0.8 * reach.columns);
    }
  }
  PixelGrid grid = PinholeGrid({0.0, 0.0});
  for (const double sine : {1.0, 1.5, 1e300}) {
    EXPECT_EQ(PinholeReach(grid, {0.1, 0.2}, sine).rows, grid.height);
    EXPECT_EQ(PinholeReach(grid, {0.1, 0.2}, sine).columns, grid.width);
  }
}

}  // namespace
}  // namespace rimod
