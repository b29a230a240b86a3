// Pinhole range images: made of scans, and what looks into them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "rimod/feature_origin.h"
#include "rimod/neighbourhood.h"
#include "rimod/pinhole_axis.h"
#include "rimod/range_image.h"
#include "rimod/scene.h"
#include "rimod/surface_rendering.h"
#include "tests/io/random_values.h"
#include "tests/support/ray_caster.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

constexpr double kDegree = M_PI / 180.0;

RangeImageParams Params() {
  RangeImageParams params;
  params.projection = Projection::kPinhole;
  params.resolution = 0.008;
  return params;
}

// A floor and a ball on it, 1.2 m below the sensor.
World Floor() {
  World world;
  world.planes = {{Eigen::Vector3d(0, 0, -1.2), Eigen::Vector3d::UnitZ()}};
  world.spheres = {{Eigen::Vector3d(0.3, 0.1, -1.0), 0.2}};
  return world;
}

Scan FloorScan(double pitch_deg, const Eigen::Isometry3d& T_local_sensor = Placed(0, 0, 0, 0)) {
  CameraPattern camera;
  camera.pitch = pitch_deg * kDegree;
  return ScanWorld(Floor(), T_local_sensor, camera);
}

TEST(PinholeAxisTest, IsTheCamerasOwnWhateverItsPitch) {
  for (int pitch_deg = -30; pitch_deg <= 85; pitch_deg += 5) {
    const std::optional<Direction> axis = PinholeAxis(FloorScan(pitch_deg), 0.1);
    ASSERT_TRUE(axis) << pitch_deg;
    EXPECT_NEAR(axis->elevation, -pitch_deg * kDegree, 1e-9);
    EXPECT_NEAR(axis->azimuth, 0.0, 1e-9) << pitch_deg;
  }
  const std::optional<Direction> down = PinholeAxis(FloorScan(89.4), 0.1);
  ASSERT_TRUE(down);
  EXPECT_EQ(down->azimuth, 0.0);
  EXPECT_NEAR(down->elevation, -M_PI / 2, 1e-12);
}

TEST(PinholeAxisTest, NeitherOrderNorDuplicatesMatter) {
  Scan scan = FloorScan(50.0);
  const std::optional<Direction> axis = PinholeAxis(scan, 0.1);
  std::mt19937 random(1);
  std::shuffle(scan.points.begin(), scan.points.end(), random);
  scan.points.insert(scan.points.end(), scan.points.begin(), scan.points.begin() + 3000);
  const std::optional<Direction> again = PinholeAxis(scan, 0.1);
  ASSERT_TRUE(axis && again);
  EXPECT_EQ(axis->azimuth, again->azimuth);
  EXPECT_EQ(axis->elevation, again->elevation);
}

TEST(PinholeAxisTest, ThereIsNoneForAWideFieldOfViewNorForNothing) {
  EXPECT_FALSE(PinholeAxis(Scan{}, 0.1));
  for (const double half_width : {1.0, 1.1, 3.1}) {
    BeamPattern pattern;
    pattern.azimuth_min = -half_width;
    pattern.azimuth_max = half_width;
    pattern.elevation_min = -0.1;
    pattern.elevation_max = 0.1;
    pattern.step = 0.02;
    const Scan scan = ScanWorld(Floor(), Placed(0, 0, 0, 0), pattern);
    EXPECT_EQ(PinholeAxis(scan, 0.1).has_value(), half_width < 60.0 * kDegree) << half_width;
    EXPECT_EQ(MakeRangeImage(scan, Params()).grid().projection,
              half_width < 60.0 * kDegree ? Projection::kPinhole : Projection::kSpherical);
  }
  Scan broken = FloorScan(20.0);
  broken.no_return_directions.push_back(Eigen::Vector3f::Constant(std::nanf("")));
  EXPECT_FALSE(PinholeAxis(broken, 0.1));
  EXPECT_FALSE(PinholeAxis(broken, 1e9));
}

TEST(PinholeImageTest, HoldsEachPixelsNearestPointWithinRounding) {
  RandomValues random(1);
  for (const double pitch_deg : {0.0, 15.0, 45.0, 75.0, 90.0}) {
    const Scan scan = FloorScan(pitch_deg, Placed(0.1, -0.2, 0.05, random.Between(-0.5, 0.5)));
    const RangeImage image = MakeRangeImage(scan, Params());
    ASSERT_EQ(image.grid().projection, Projection::kPinhole);
    std::vector<double> nearest(image.grid().size(), 1e9);
    std::vector<std::vector<Eigen::Vector3d>> points(nearest.size());
    for (const Eigen::Vector3f& p_local : scan.points) {
      const Eigen::Vector3d p = scan.T_local_sensor.inverse() * p_local.cast<double>();
      const PixelPosition at = Project(image.grid(), p);
      const int row = static_cast<int>(std::floor(at.row));
      const int column = static_cast<int>(std::floor(at.column));
      ASSERT_TRUE(image.grid().Contains(row, column));
      const int pixel = row * image.width() + column;
      points[pixel].push_back(p);
      nearest[pixel] = std::min(nearest[pixel], p.norm());
    }
    int num_measured = 0;
    for (int pixel = 0; pixel < image.grid().size(); ++pixel) {
      const int row = pixel / image.width(), column = pixel % image.width();
      ASSERT_EQ(image.measured(row, column), nearest[pixel] < 1e9);
      if (!image.measured(row, column)) continue;
      ++num_measured;
      EXPECT_NEAR(image.range(row, column), nearest[pixel], PixelRounding::kRangeUnit);
      // Of points whose ranges are rounded to the same any may be it.
      const double aside = image.grid().resolution / PixelRounding::kOffsetSteps;
      EXPECT_TRUE(
          std::any_of(points[pixel].begin(), points[pixel].end(), [&](const Eigen::Vector3d& p) {
            return (image.point(row, column).cast<double>() - p).norm() <
                   PixelRounding::kRangeUnit + nearest[pixel] * aside;
          }));
    }
    EXPECT_GT(num_measured, 7000);
  }
}

TEST(PinholeImageTest, FillsTheImageOfACameraThatLooksDown) {
  for (const double pitch_deg : {45.0, 75.0, 90.0}) {
    const Scan scan = FloorScan(pitch_deg);
    const RangeImage image = MakeRangeImage(scan, Params());
    EXPECT_GT(image.CountMeasured(), 0.9 * image.grid().size()) << pitch_deg;
  }
  RangeImageParams spherical = Params();
  spherical.projection = Projection::kSpherical;
  const RangeImage around = MakeRangeImage(FloorScan(90.0), spherical);
  EXPECT_LT(around.CountMeasured(), 0.4 * around.grid().size());
}

TEST(PinholeImageTest, SparseScansGetLargerPixels) {
  RangeImageParams params = Params();
  params.resolution = 0.002;
  params.max_resolution = 0.05;
  const RangeImage image = MakeRangeImage(FloorScan(60.0), params);
  EXPECT_GT(image.grid().resolution, 0.6 / 140.0);
  EXPECT_LT(image.grid().resolution, 1.7 / 140.0);
}

TEST(PinholeImageTest, BeamsWithoutReturnAreInIt) {
  CameraPattern camera;
  camera.pitch = 20.0 * kDegree;
  const Scan scan = ScanWorld(Floor(), Placed(0, 0, 0, 0), camera);
  ASSERT_GT(scan.no_return_directions.size(), 100u);
  const RangeImage image = MakeRangeImage(scan, Params());
  for (const Eigen::Vector3f& beam : scan.no_return_directions) {
    const PixelPosition at = Project(image.grid(), beam.cast<double>());
    EXPECT_NE(image.pixel(static_cast<int>(at.row), static_cast<int>(at.column)),
              Pixel::kNeverObserved);
  }
}

TEST(PinholeImageTest, NeighbourhoodsHoldAllPointsWithinTheRadius) {
  const RangeImage image = MakeRangeImage(FloorScan(45.0), Params());
  RandomValues random(2);
  for (int i = 0; i < 300; ++i) {
    const PixelIndex pixel = {random.Int(0, image.height() - 1), random.Int(0, image.width() - 1)};
    if (!image.measured(pixel.row, pixel.column)) continue;
    const double radius = random.Between(0.01, 0.08);
    int visited = 0, thinned_by = 1, within = 0;
    VisitNeighbourhood(image, pixel, radius, [&](const Eigen::Vector3f&, int step) {
      ++visited;
      thinned_by = step;
    });
    if (thinned_by > 1) continue;
    const Eigen::Vector3f centre = image.point(pixel.row, pixel.column);
    for (int row = 0; row < image.height(); ++row)
      for (int column = 0; column < image.width(); ++column)
        within +=
            image.measured(row, column) && (image.point(row, column) - centre).squaredNorm() <=
                                               static_cast<float>(radius * radius);
    EXPECT_EQ(visited, within);
  }
}

TEST(PinholeImageTest, FeaturesAreRecognisedAsTheImagesOwn) {
  const RangeImage image = MakeRangeImage(FloorScan(75.0), Params());
  const RangeImage other = MakeRangeImage(FloorScan(60.0), Params());
  FeatureSet features;
  for (int column = 0; column < image.width(); column += 7) {
    if (!image.measured(20, column)) continue;
    features.features.emplace_back();
    features.features.back().position = image.point(20, column);
  }
  ASSERT_GT(features.features.size(), 10u);
  EXPECT_TRUE(AreFeaturesOf(image, features));
  EXPECT_FALSE(AreFeaturesOf(other, features));
}

PixelGrid Grid(const Direction& axis, double resolution = 0.005) {
  PixelGrid grid;
  grid.width = 300;
  grid.height = 240;
  grid.resolution = resolution;
  grid.left = 0.5 * grid.width * resolution;
  grid.top = 0.5 * grid.height * resolution;
  grid.projection = Projection::kPinhole;
  grid.axis = axis;
  return grid;
}

TEST(PinholeSceneTest, ItsFastProjectionAgreesWithTheExactOne) {
  RandomValues random(2);
  const PixelGrid grid = Grid({0.7, -1.1}, 0.007);
  const Scene scene(RangeImage(grid, Eigen::Isometry3d::Identity()), 0.1, Execution{});
  const Eigen::Isometry3d pose = random.Pose();
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 20003; ++i)
    points.push_back(
        (pose.inverse() * (random.Between(2.0, 80.0) * random.Unit())).eval().cast<float>());
  ProjectedPoints projected;
  scene.Project(PointColumns(points), pose.cast<float>(), 0, points.size(), &projected);
  int inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = pose * points[i].cast<double>();
    EXPECT_NEAR(projected.ranges[i], p.norm(), 1e-5 * p.norm() + 1e-5);
    const PixelPosition exact = Project(grid, p);
    const double row_rest = exact.row - std::floor(exact.row);
    const double column_rest = exact.column - std::floor(exact.column);
    if (std::min({row_rest, 1 - row_rest, column_rest, 1 - column_rest}) < 0.01) continue;
    const int row = static_cast<int>(std::floor(exact.row));
    const int column = static_cast<int>(std::floor(exact.column));
    const int expected = grid.Contains(row, column) ? row * grid.width + column : -1;
    ASSERT_EQ(projected.pixels[i], expected) << p.transpose();
    inside += expected >= 0;
  }
  EXPECT_GT(inside, 1500);
}

TEST(PinholeSceneTest, HostilePointsAreOutside) {
  const Scene scene(RangeImage(Grid({0.0, 0.0}), Eigen::Isometry3d::Identity()), 0.1, Execution{});
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<Eigen::Vector3f> points = {
      {0, 0, 0},   {-1, 0, 0},  {-1e-38f, 0, 0}, {1e-38f, 1, 0}, {0, 1, 1}, {std::nanf(""), 0, 0},
      {1, inf, 0}, {inf, 0, 0}, {-inf, 0, 0},    {1, 1e20f, 0}};
  ProjectedPoints projected;
  scene.Project(PointColumns(points), Eigen::Isometry3f::Identity(), 0, points.size(), &projected);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(projected.pixels[i], -1) << i;
}

TEST(PinholeSceneTest, NormalsAreThoseOfTheFloor) {
  const Scene scene(MakeRangeImage(FloorScan(70.0), Params()), 0.05, Execution{});
  int num_floor = 0, num_upright = 0;
  for (int pixel = 0; pixel < scene.grid().size(); ++pixel) {
    if (!(scene.range(pixel) > 0.0f) || std::abs(scene.point(pixel).z() + 1.2f) > 0.01f) continue;
    ++num_floor;
    num_upright += scene.normal(pixel).z() > 0.98f;
  }
  EXPECT_GT(num_floor, 5000);
  EXPECT_GT(num_upright, 0.95 * num_floor);
}

// Ranges of a rendering against those of beams cast at the world.
struct Comparison {
  int both = 0, missing = 0, excess = 0;
  double worst = 0.0, sum = 0.0;
};

Comparison Compare(const RenderedModel& rendered, const World& world, const PixelGrid& grid) {
  Comparison result;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const double truth =
          CastBeam(world, Eigen::Vector3d::Zero(), PixelBeam(grid, row + 0.5, column + 0.5))
              .value_or(0.0);
      const int r = row - rendered.first_row, c = column - rendered.first_column;
      const bool in_window = r >= 0 && c >= 0 && r < rendered.height && c < rendered.width;
      const double range = in_window ? rendered.range(r, c) : 0.0;
      result.both += truth > 0.0 && range > 0.0;
      result.missing += truth > 0.0 && range <= 0.0;
      result.excess += truth <= 0.0 && range > 0.0;
      if (!(truth > 0.0 && range > 0.0)) continue;
      result.worst = std::max(result.worst, std::abs(truth - range));
      result.sum += std::abs(truth - range);
    }
  }
  return result;
}

TEST(PinholeRenderingTest, APlaneHasItsExactDepth) {
  const ObjectModel plate = PlateModel("plate", 0.6, 0.01);
  RandomValues random(3);
  for (int i = 0; i < 12; ++i) {
    const Direction axis = {random.Between(-3, 3), random.Between(-1.5, 1.5)};
    const PixelGrid grid = Grid(axis);
    // Faces the sensor but for a turn, in the image's middle or aside.
    const Eigen::Vector3d middle =
        2.0 * PixelBeam(grid, random.Between(90, 150), random.Between(100, 200));
    const Eigen::Vector3d normal = (-middle.normalized() + 0.7 * random.Unit()).normalized();
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), normal).toRotationMatrix();
    T.translation() = middle - T.linear() * Eigen::Vector3d(0, 0, 0.3);
    World world;  // the plate as a very thin box
    BoxShape box;
    box.half_size = Eigen::Vector3d(1e-6, 0.3, 0.3);
    box.T_local_box = T * Eigen::Translation3d(0, 0, 0.3);
    world.boxes = {box};
    const Comparison result = Compare(RenderModel(plate, T, grid), world, grid);
    EXPECT_GT(result.both, 600);
    EXPECT_LT(result.worst, 0.001);
    EXPECT_EQ(result.missing, 0);
    EXPECT_LT(result.excess, result.both / 4);  // a rim of at most a disc and a pixel
  }
}

TEST(PinholeRenderingTest, ABallBelowHasItsDepth) {
  const ObjectModel ball = SphereModel("ball", 0.4, 0.01);
  for (const double elevation_deg : {-90.0, -70.0, -50.0}) {
    const PixelGrid grid = Grid({0.0, elevation_deg * kDegree});
    const Eigen::Vector3d centre = 2.0 * PixelBeam(grid, 100, 190);
    World world;
    world.spheres = {{centre, 0.4}};
    const Eigen::Isometry3d T = Placed(centre.x(), centre.y(), centre.z() - 0.4, 0.3);
    const Comparison result = Compare(RenderModel(ball, T, grid), world, grid);
    EXPECT_GT(result.both, 3000);
    EXPECT_LT(result.sum / result.both, 0.002);
    EXPECT_LT(result.missing, result.both / 50);
    EXPECT_LT(result.excess, result.both / 20);
  }
}

TEST(PinholeRenderingTest, WhatIsBehindOrBesideIsNotSeen) {
  const ObjectModel ball = SphereModel("ball", 0.4, 0.02);
  const PixelGrid grid = Grid({0.0, -M_PI / 2});
  for (const Eigen::Vector3d& place : {Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(3, 0, 0),
                                       Eigen::Vector3d(0, -3, 0.5), Eigen::Vector3d(0, 0, 0.3)}) {
    const RenderedModel rendered =
        RenderModel(ball, Placed(place.x(), place.y(), place.z(), 0.0), grid);
    EXPECT_EQ(rendered.CountSeen(), 0) << place.transpose();
  }
  // Around the sensor, and as near as can be: nothing but finite numbers.
  const RenderedModel around = RenderModel(ball, Placed(0, 0, -0.41, 0.0), grid);
  for (const float range : around.ranges) EXPECT_TRUE(std::isfinite(range));
}

}  // namespace
}  // namespace rimod
