#include "rimod/range_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <utility>

#include "tests/io/random_values.h"
#include "tests/support/executions.h"
#include "tests/support/matchers.h"

namespace rimod {
namespace {

constexpr double kResolution = 0.0069;

PixelGrid Grid(int width, int height) {
  PixelGrid grid;
  grid.width = width;
  grid.height = height;
  grid.resolution = 0.01;
  grid.left = 0.3;
  grid.top = 0.2;
  return grid;
}

RangeImageParams Params(double resolution = kResolution, double min_range = 0.1) {
  RangeImageParams params;
  params.resolution = resolution;
  params.min_range = min_range;
  return params;
}

// The middle of a pixel as a beam.
ImageCoordinates Centre(const PixelGrid& grid, int row, int column) {
  return CoordinatesAt(grid, row + 0.5, column + 0.5);
}

bool SameBits(const RangeImage& a, const RangeImage& b) {
  if (!(a.grid() == b.grid())) return false;
  for (int row = 0; row < a.height(); ++row) {
    for (int column = 0; column < a.width(); ++column) {
      if (a.pixel(row, column) != b.pixel(row, column) ||
          a.range(row, column) != b.range(row, column) ||
          a.point(row, column) != b.point(row, column))
        return false;
    }
  }
  return true;
}

TEST(ProjectionTest, DirectionsAndUnitVectorsAreInverse) {
  RandomValues random(1);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d unit = random.Unit();
    EXPECT_NEAR((UnitVector(DirectionOf(random.Between(0.1, 80.0) * unit)) - unit).norm(), 0.0,
                1e-12);
  }
}

TEST(ProjectionTest, AxesFollowTheConventions) {
  EXPECT_NEAR(DirectionOf({1, 0, 0}).azimuth, 0.0, 1e-15);
  EXPECT_NEAR(DirectionOf({0, 1, 0}).azimuth, M_PI / 2, 1e-15);
  EXPECT_NEAR(DirectionOf({1, 0, 1}).elevation, M_PI / 4, 1e-15);
  // Left of and above a beam are smaller columns and rows.
  const PixelGrid grid = Grid(60, 40);
  EXPECT_LT(Project(grid, {1, 0.1, 0}).column, Project(grid, {1, 0, 0}).column);
  EXPECT_LT(Project(grid, {1, 0, 0.1}).row, Project(grid, {1, 0, 0}).row);
}

TEST(ProjectionTest, ProjectInvertsPixelDirection) {
  RandomValues random(2);
  for (int i = 0; i < 1000; ++i) {
    const PixelGrid grid = Grid(60, 40);
    const double row = random.Between(0.0, 40.0), column = random.Between(0.0, 60.0);
    const Eigen::Vector3d p =
        random.Between(0.2, 50.0) * UnitVector(PixelDirection(grid, row, column));
    EXPECT_NEAR(Project(grid, p).row, row, 1e-9);
    EXPECT_NEAR(Project(grid, p).column, column, 1e-9);
  }
}

TEST(RangeImageTest, BeginsUnobserved) {
  const RangeImage image(Grid(3, 2), Eigen::Isometry3d::Identity());
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) {
      EXPECT_EQ(image.pixel(row, column), Pixel::kNeverObserved);
      EXPECT_EQ(image.range(row, column), 0.0f);
      EXPECT_TRUE(image.point(row, column).isZero());
    }
  }
  EXPECT_EQ(image.CountMeasured(), 0);
}

TEST(RangeImageTest, KeepsThreeKindsOfPixelsApart) {
  RangeImage image(Grid(3, 1), Eigen::Isometry3d::Identity());
  image.SetMeasured(0, 0, {800, 0, 0});
  image.SetNoReturn(0, 1);
  EXPECT_EQ(image.pixel(0, 0), Pixel::kMeasured);
  EXPECT_EQ(image.pixel(0, 1), Pixel::kNoReturn);
  EXPECT_EQ(image.pixel(0, 2), Pixel::kNeverObserved);
  EXPECT_EQ(image.CountMeasured(), 1);
  EXPECT_FLOAT_EQ(image.range(0, 0), 1.0f);
  EXPECT_EQ(image.range(0, 1), 0.0f);

  image.SetNoReturn(0, 0);
  image.SetMeasured(0, 1, {1600, 0, 0});
  EXPECT_EQ(image.pixel(0, 0), Pixel::kNoReturn);
  EXPECT_TRUE(image.point(0, 0).isZero());
  EXPECT_EQ(image.pixel(0, 1), Pixel::kMeasured);
}

TEST(RangeImageTest, AMeasurementOutlivesABeamWithoutReturn) {
  const PixelGrid grid = Grid(2, 1);
  RangeImage image(grid, Eigen::Isometry3d::Identity());
  image.AddBeams({Centre(grid, 0, 0)}, {2.0});
  image.AddNoReturn(Centre(grid, 0, 0));
  image.AddNoReturn(Centre(grid, 0, 1));
  EXPECT_EQ(image.pixel(0, 0), Pixel::kMeasured);
  EXPECT_EQ(image.pixel(0, 1), Pixel::kNoReturn);
  image.AddBeams({Centre(grid, 0, 1)}, {3.0});
  EXPECT_EQ(image.pixel(0, 1), Pixel::kMeasured);
}

TEST(RangeImageTest, NearerPointWinsThePixel) {
  const PixelGrid grid = Grid(1, 1);
  const ImageCoordinates beam = Centre(grid, 0, 0);
  for (const auto& ranges : {std::vector<double>{2.0, 3.0}, std::vector<double>{3.0, 2.0}}) {
    RangeImage together(grid, Eigen::Isometry3d::Identity());
    together.AddBeams({beam, beam}, ranges);
    EXPECT_FLOAT_EQ(together.range(0, 0), 2.0f);
    RangeImage one_by_one(grid, Eigen::Isometry3d::Identity());
    for (const double range : ranges) one_by_one.AddBeams({beam}, {range});
    EXPECT_FLOAT_EQ(one_by_one.range(0, 0), 2.0f);
  }
}

TEST(RangeImageTest, BeamsOutsideAreLeftOut) {
  const PixelGrid grid = Grid(4, 4);
  RangeImage image(grid, Eigen::Isometry3d::Identity());
  for (const auto& [row, column] :
       {std::pair{-1, 0}, std::pair{0, -1}, std::pair{4, 0}, std::pair{0, 4}, std::pair{900, 2}}) {
    image.AddBeams({Centre(grid, row, column)}, {1.0});
    image.AddNoReturn(Centre(grid, row, column));
  }
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      EXPECT_EQ(image.pixel(row, column), Pixel::kNeverObserved);
}

TEST(RangeImageTest, RoundedPixelsGiveBackTheSameBits) {
  RandomValues random(3);
  const RangeImage image = random.AnImage(70, 50);
  RangeImage copy(image.grid(), image.T_local_sensor());
  for (int row = 0; row < image.height(); ++row) {
    for (int column = 0; column < image.width(); ++column) {
      if (image.pixel(row, column) == Pixel::kNoReturn) copy.SetNoReturn(row, column);
      if (image.measured(row, column)) copy.SetMeasured(row, column, image.rounded(row, column));
    }
  }
  EXPECT_TRUE(SameBits(image, copy));
}

TEST(RangeImageTest, RejectsAbsurdGrids) {
  const Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  EXPECT_THROW(RangeImage(Grid(-1, 5), T), std::invalid_argument);
  EXPECT_THROW(RangeImage(Grid(5, -1), T), std::invalid_argument);
  EXPECT_THROW(RangeImage(Grid(5000, 5000), T), std::invalid_argument);
  EXPECT_THROW(RangeImage(Grid(2'000'000'000, 2'000'000'000), T), std::invalid_argument);
  for (const double resolution : {0.0, -0.01, std::nan(""), HUGE_VAL}) {
    PixelGrid grid = Grid(5, 5);
    grid.resolution = resolution;
    EXPECT_THROW(RangeImage(grid, T), std::invalid_argument) << resolution;
  }
  PixelGrid grid = Grid(5, 5);
  grid.left = std::nan("");
  EXPECT_THROW(RangeImage(grid, T), std::invalid_argument);
  grid = Grid(5, 5);
  grid.top = HUGE_VAL;
  EXPECT_THROW(RangeImage(grid, T), std::invalid_argument);
}

TEST(MakeRangeImageTest, EmptyScanGivesAnEmptyImage) {
  const RangeImage image = MakeRangeImage(Scan{}, Params());
  EXPECT_EQ(image.grid().size(), 0);
  EXPECT_EQ(image.CountMeasured(), 0);
}

TEST(MakeRangeImageTest, EachPixelHoldsTheNearestOfItsPoints) {
  RandomValues random(4);
  const Scan scan = random.AScan(20000, 3000);
  const double min_range = 5.0;
  const RangeImage image = MakeRangeImage(scan, Params(0.05, min_range));
  std::map<std::pair<int, int>, double> nearest;
  for (const Eigen::Vector3f& p_local : scan.points) {
    const Eigen::Vector3d p = scan.T_local_sensor.inverse() * p_local.cast<double>();
    if (p.norm() < min_range) continue;
    const PixelPosition position = Project(image.grid(), p);
    const std::pair<int, int> pixel(std::floor(position.row), std::floor(position.column));
    ASSERT_TRUE(image.grid().Contains(pixel.first, pixel.second));
    const auto [entry, is_new] = nearest.emplace(pixel, p.norm());
    if (!is_new) entry->second = std::min(entry->second, p.norm());
  }
  EXPECT_EQ(image.CountMeasured(), static_cast<int>(nearest.size()));
  for (const auto& [pixel, range] : nearest) {
    EXPECT_EQ(image.pixel(pixel.first, pixel.second), Pixel::kMeasured);
    EXPECT_NEAR(image.range(pixel.first, pixel.second), range, 0.0007);
  }
}

TEST(MakeRangeImageTest, PointsStayWhereTheyWereMeasured) {
  RandomValues random(5);
  for (int i = 0; i < 300; ++i) {
    Scan scan = random.AScan(1, 0);
    const Eigen::Vector3d p = scan.T_local_sensor.inverse() * scan.points[0].cast<double>();
    const RangeImage image = MakeRangeImage(scan, Params());
    ASSERT_EQ(image.grid().size(), 1);
    // Half a step of range and of direction, each way.
    const double tolerance = 0.0007 + p.norm() * kResolution / PixelRounding::kOffsetSteps;
    EXPECT_NEAR((image.point(0, 0).cast<double>() - p).norm(), 0.0, tolerance);
    EXPECT_NEAR(image.range(0, 0), image.point(0, 0).norm(), 1e-4);
  }
}

// The edges of the grid are multiples of the resolution; beams along them must not fall off it.
TEST(MakeRangeImageTest, KeepsPointsOnPixelEdges) {
  for (const Eigen::Vector3f& p :
       {Eigen::Vector3f(2, 0, 0), Eigen::Vector3f(0, 2, 0), Eigen::Vector3f(-2, 0, 0),
        Eigen::Vector3f(0, -2, 0), Eigen::Vector3f(0, 0, 2), Eigen::Vector3f(0, 0, -2)}) {
    Scan scan;
    scan.points = {p};
    const RangeImage image = MakeRangeImage(scan, Params());
    EXPECT_EQ(image.CountMeasured(), 1) << p.transpose();
  }
  const double resolution = 0.0078125;  // exact in binary
  for (int k = -40; k <= 40; ++k) {
    for (const Direction& beam : {Direction{k * resolution, 0.0}, Direction{0.0, k * resolution}}) {
      Scan scan;
      scan.points = {(2.0 * UnitVector(beam)).cast<float>()};
      EXPECT_EQ(MakeRangeImage(scan, Params(resolution)).CountMeasured(), 1) << k;
    }
  }
}

TEST(MakeRangeImageTest, KeepsNoReturnBeamsOnPixelEdges) {
  Scan scan;
  scan.no_return_directions = {Eigen::Vector3f::UnitX()};
  const RangeImage image = MakeRangeImage(scan, Params());
  ASSERT_GE(image.grid().size(), 1);
  int no_returns = 0;
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column)
      no_returns += image.pixel(row, column) == Pixel::kNoReturn;
  EXPECT_EQ(no_returns, 1);
  EXPECT_EQ(image.CountMeasured(), 0);
}

TEST(MakeRangeImageTest, LeavesOutPointsOfTheCarrierAndThoseThatAreNoNumbers) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Scan scan;
  scan.points = {{0.2f, 0.0f, 0.1f}, {0.0f, 0.0f, 0.0f}, {nan, 1.0f, 1.0f}, {3.0f, nan, nan}};
  EXPECT_EQ(MakeRangeImage(scan, Params(kResolution, 0.3)).grid().size(), 0);
  scan.points.push_back({2.0f, 0.3f, 0.1f});
  const RangeImage image = MakeRangeImage(scan, Params(kResolution, 0.3));
  EXPECT_EQ(image.grid().size(), 1);
  EXPECT_EQ(image.CountMeasured(), 1);
}

TEST(MakeRangeImageTest, VeryFarPointsAreAsFarAsCanBe) {
  Scan scan;
  scan.points = {{500.0f, 20.0f, 10.0f}};
  const RangeImage image = MakeRangeImage(scan, Params());
  EXPECT_FLOAT_EQ(image.range(0, 0),
                  static_cast<float>(PixelRounding::kMaxRangeSteps * PixelRounding::kRangeUnit));
}

TEST(MakeRangeImageTest, DuplicatesChangeNothingAndOrderNeither) {
  RandomValues random(6);
  Scan scan = random.AScan(2000, 200);
  const RangeImage image = MakeRangeImage(scan, Params(0.02));
  Scan doubled = scan;
  doubled.points.insert(doubled.points.end(), scan.points.begin(), scan.points.end());
  EXPECT_TRUE(SameBits(MakeRangeImage(doubled, Params(0.02)), image));
}

TEST(MakeRangeImageTest, SeesARigidlyMovedScanAlike) {
  RandomValues random(7);
  Scan scan = random.AScan(500, 0);
  const RangeImage image = MakeRangeImage(scan, Params());
  const Eigen::Isometry3d T = random.Level();
  Scan moved;
  moved.T_local_sensor = T * scan.T_local_sensor;
  for (const Eigen::Vector3f& p : scan.points)
    moved.points.push_back((T * p.cast<double>()).cast<float>());
  const RangeImage again = MakeRangeImage(moved, Params());
  int equal = 0;
  for (int row = 0; row < image.height(); ++row) {
    for (int column = 0; column < image.width(); ++column) {
      if (!image.measured(row, column) || !again.grid().Contains(row, column)) continue;
      equal += (image.point(row, column) - again.point(row, column)).norm() < 0.003f;
    }
  }
  EXPECT_GE(equal, 490);  // some fall into the neighbouring pixel by rounding
}

// A wall 3 m ahead measured every spacing (rad), slightly unevenly.
Scan WallOfBeams(double spacing) {
  RandomValues random(9);
  Scan scan;
  for (double azimuth = -0.5; azimuth < 0.5; azimuth += spacing) {
    for (double elevation = -0.4; elevation < 0.4; elevation += spacing) {
      const Direction beam{azimuth + random.Between(-0.1, 0.1) * spacing,
                           elevation + random.Between(-0.1, 0.1) * spacing};
      scan.points.push_back((3.0 * UnitVector(beam)).cast<float>());
    }
  }
  return scan;
}

TEST(MakeRangeImageTest, SparseScansGetLargerPixels) {
  RangeImageParams params = Params(0.01);
  params.min_filled = 0.7;
  for (const double spacing : {0.003, 0.005, 0.007}) {
    params.max_resolution = 0.05;
    EXPECT_EQ(MakeRangeImage(WallOfBeams(spacing), params).grid().resolution, 0.01) << spacing;
  }
  for (const double spacing : {0.015, 0.02, 0.03}) {
    params.max_resolution = 0.05;
    const RangeImage image = MakeRangeImage(WallOfBeams(spacing), params);
    EXPECT_GT(image.grid().resolution, 0.7 * spacing);
    EXPECT_LT(image.grid().resolution, 1.6 * spacing);
    EXPECT_GT(image.CountMeasured(), 0.6 * image.grid().size());
    params.max_resolution = 0.0;  // never
    EXPECT_EQ(MakeRangeImage(WallOfBeams(spacing), params).grid().resolution, 0.01);
  }
  params.max_resolution = 0.014;  // no larger, however sparse
  EXPECT_LE(MakeRangeImage(WallOfBeams(0.05), params).grid().resolution, 0.014);
  EXPECT_EQ(MakeRangeImage(Scan{}, params).grid().size(), 0);
}

TEST(RangeImageParamsTest, RejectsWhatIsOutOfRange) {
  for (const double resolution : {0.0, -1.0, 0.2, std::nan("")})
    EXPECT_TRUE(Complains([&] { Params(resolution).Validate(); }, {"resolution"}));
  for (const double min_range : {-0.1, HUGE_VAL, std::nan("")})
    EXPECT_TRUE(Complains([&] { Params(0.01, min_range).Validate(); }, {"min_range"}));
  EXPECT_NO_THROW(Params().Validate());
}

TEST(MakeRangeImageTest, ThreadsAndOrderDoNotMatter) {
  Scan scan = RandomValues(31).AScan(5003, 301);
  scan.points[17].setConstant(std::numeric_limits<float>::quiet_NaN());
  scan.points.insert(scan.points.end(), scan.points.begin(), scan.points.begin() + 100);
  const RangeImage alone = MakeRangeImage(scan, Params());
  ASSERT_GT(alone.CountMeasured(), 1000);
  for (const Execution& execution : {OnThreads(4), Backwards()}) {
    const RangeImage other = MakeRangeImage(scan, Params(), execution);
    ASSERT_TRUE(other.grid() == alone.grid());
    for (int row = 0; row < alone.height(); ++row) {
      for (int column = 0; column < alone.width(); ++column) {
        ASSERT_EQ(other.pixel(row, column), alone.pixel(row, column));
        ASSERT_EQ(other.point(row, column), alone.point(row, column));
      }
    }
  }
}

}  // namespace
}  // namespace rimod
