#include "rimod/interest_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "tests/io/random_values.h"
#include "tests/support/executions.h"
#include "tests/support/ray_caster.h"

namespace rimod {
namespace {

constexpr InterestMeasure kMeasures[] = {InterestMeasure::kHarris, InterestMeasure::kSurfaceChange};

InterestPointParams Params(InterestMeasure measure) {
  InterestPointParams params;
  params.measure = measure;
  params.max_points = 500;
  params.harris_window = 3;
  params.harris_k = 0.04;
  params.max_depth_jump = 0.3;
  params.bend_step = 0.05;
  params.min_strength = 1e-6;
  params.suppression_radius = 0.05;
  params.max_range = 30.0;
  return params;
}

// A box and a ball before a wall, on a floor; with noise.
const RangeImage& Scene() {
  static const RangeImage image = [] {
    World world;
    world.planes = {{Eigen::Vector3d(4, 0, 0), -Eigen::Vector3d::UnitX()},
                    {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d::UnitZ()}};
    world.spheres = {{Eigen::Vector3d(2.5, 0.6, -0.3), 0.3}};
    BoxShape box;
    box.T_local_box = Placed(2.2, -0.3, -0.3, 0.6);
    box.half_size = Eigen::Vector3d(0.25, 0.2, 0.3);
    world.boxes = {box};
    BeamPattern pattern;
    pattern.noise = 0.004;
    RangeImageParams params;
    params.resolution = 0.0069;
    return MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), pattern), params);
  }();
  return image;
}

const Eigen::Vector3f& PointOf(const RangeImage& image, const PixelIndex& pixel) {
  return image.point(pixel.row, pixel.column);
}

TEST(InterestPointsTest, AreMeasuredPixelsInsideTheImage) {
  for (const InterestMeasure measure : kMeasures) {
    const std::vector<PixelIndex> found = FindInterestPoints(Scene(), Params(measure));
    EXPECT_GT(found.size(), 20u);
    for (const PixelIndex& pixel : found) {
      ASSERT_TRUE(Scene().grid().Contains(pixel.row, pixel.column));
      EXPECT_TRUE(Scene().measured(pixel.row, pixel.column));
    }
  }
}

TEST(InterestPointsTest, FewerAreTheStrongest) {
  for (const InterestMeasure measure : kMeasures) {
    InterestPointParams params = Params(measure);
    const std::vector<PixelIndex> all = FindInterestPoints(Scene(), params);
    for (const int count : {1, 7, 20}) {
      params.max_points = count;
      const std::vector<PixelIndex> few = FindInterestPoints(Scene(), params);
      ASSERT_EQ(static_cast<int>(few.size()), count);
      EXPECT_TRUE(std::equal(few.begin(), few.end(), all.begin()));
    }
  }
}

TEST(InterestPointsTest, NoTwoAreNearerThanTheSuppressionRadius) {
  for (const InterestMeasure measure : kMeasures) {
    InterestPointParams params = Params(measure);
    std::size_t before = 1'000'000;
    for (const double radius : {0.0, 0.04, 0.15}) {
      params.suppression_radius = radius;
      params.max_points = 100'000;
      const std::vector<PixelIndex> found = FindInterestPoints(Scene(), params);
      EXPECT_LT(found.size(), before);
      before = found.size();
      if (radius == 0.0) continue;
      float nearest = 1000.0f;
      for (std::size_t i = 0; i < found.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          nearest =
              std::min(nearest, (PointOf(Scene(), found[i]) - PointOf(Scene(), found[j])).norm());
      EXPECT_GE(nearest, radius - 1e-6);
    }
  }
}

TEST(InterestPointsTest, CornersOfABoxAreAmongThem) {
  World world;
  world.planes = {{Eigen::Vector3d(4, 0, 0), -Eigen::Vector3d::UnitX()}};
  BoxShape box;
  box.T_local_box = Placed(2.0, 0.0, 0.0, 0.0);
  box.half_size = Eigen::Vector3d(0.1, 0.3, 0.25);
  world.boxes = {box};
  RangeImageParams image_params;
  image_params.resolution = 0.0069;
  const RangeImage image =
      MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{}), image_params);
  for (const InterestMeasure measure : kMeasures) {
    const std::vector<PixelIndex> found = FindInterestPoints(image, Params(measure));
    for (const double y : {-0.3, 0.3}) {
      for (const double z : {-0.25, 0.25}) {
        const PixelPosition corner = Project(image.grid(), {1.9, y, z});
        double nearest = 1000.0;  // pixels
        for (const PixelIndex& p : found) {
          nearest = std::min(nearest,
                             std::hypot(p.row + 0.5 - corner.row, p.column + 0.5 - corner.column));
        }
        EXPECT_LT(nearest, 6.0)  // the suppression radius and two
            << (measure == InterestMeasure::kHarris) << ' ' << y << ' ' << z;
      }
    }
  }
}

TEST(InterestPointsTest, AWallHasNoneInItsMiddle) {
  World world;
  world.planes = {{Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(-1, 0.2, 0.1).normalized()}};
  RangeImageParams image_params;
  image_params.resolution = 0.0069;
  const RangeImage image =
      MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{}), image_params);
  for (const InterestMeasure measure : kMeasures) {
    InterestPointParams params = Params(measure);
    params.min_strength = 1e-4;
    for (const PixelIndex& pixel : FindInterestPoints(image, params)) {
      const bool at_the_rim = pixel.row < 10 || pixel.column < 10 ||
                              pixel.row >= image.height() - 10 ||
                              pixel.column >= image.width() - 10;
      EXPECT_TRUE(at_the_rim) << pixel.row << ' ' << pixel.column;
    }
  }
}

TEST(InterestPointsTest, ACubeHoldsItsStrongestOnly) {
  for (const InterestMeasure measure : kMeasures) {
    InterestPointParams params = Params(measure);
    params.cube_side = 0.5;
    params.max_points = 100'000;
    params.suppression_radius = 0.0;
    const std::vector<PixelIndex> all = FindInterestPoints(Scene(), params);
    params.max_points_a_cube = 5;
    std::map<std::array<int, 3>, int> counts;
    std::vector<PixelIndex> expected;
    for (const PixelIndex& pixel : all) {
      const Eigen::Vector3f cube = (PointOf(Scene(), pixel) / 0.5f).array().floor();
      int& count = counts[{int(cube.x()), int(cube.y()), int(cube.z())}];
      if (++count <= 5) expected.push_back(pixel);
    }
    ASSERT_LT(expected.size(), all.size());
    EXPECT_EQ(FindInterestPoints(Scene(), params), expected);
  }
}

// A ledge whose one end is hidden by a post: what is seen of it beside the post is found.
TEST(InterestPointsTest, SurfacesBesideSomethingNearerHaveThem) {
  World world;
  world.planes = {{Eigen::Vector3d(4, 0, 0), -Eigen::Vector3d::UnitX()}};
  BoxShape ledge, post;
  ledge.T_local_box = Placed(3.0, 0.0, 0.0, 0.0);
  ledge.half_size = Eigen::Vector3d(0.25, 0.08, 0.08);
  post.T_local_box = Placed(2.0, 0.07, 0.0, 0.0);
  post.half_size = Eigen::Vector3d(0.03, 0.03, 0.8);
  world.boxes = {ledge, post};
  RangeImageParams image_params;
  image_params.resolution = 0.0069;
  const RangeImage image =
      MakeRangeImage(ScanWorld(world, Placed(0.0, 0.0, 0.9, 0.0), BeamPattern{}), image_params);
  InterestPointParams params = Params(InterestMeasure::kSurfaceChange);
  int on_the_ledge = 0;
  for (const PixelIndex& pixel : FindInterestPoints(image, params)) {
    const Eigen::Vector3f p = PointOf(image, pixel);
    on_the_ledge += p.x() > 2.7f && p.x() < 3.3f && std::abs(p.y()) < 0.1f;
  }
  EXPECT_GE(on_the_ledge, 2);
}

// Far away the rows on a floor lie farther apart than a depth jump.
TEST(InterestPointsTest, AFloorFarAwayIsNoEdge) {
  World world;
  world.planes = {{Eigen::Vector3d(0, 0, -1), Eigen::Vector3d::UnitZ()}};
  RangeImageParams image_params;
  image_params.resolution = 0.0069;
  const RangeImage image =
      MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{}), image_params);
  for (const PixelIndex& pixel :
       FindInterestPoints(image, Params(InterestMeasure::kSurfaceChange))) {
    const float range = image.range(pixel.row, pixel.column);
    EXPECT_FALSE(range > 4.0f && range < 12.0f) << range;
  }
}

TEST(InterestPointsTest, KeepToTheMaximumRange) {
  for (const InterestMeasure measure : kMeasures) {
    InterestPointParams params = Params(measure);
    params.max_range = 2.4;
    const std::vector<PixelIndex> found = FindInterestPoints(Scene(), params);
    EXPECT_FALSE(found.empty());
    for (const PixelIndex& pixel : found) EXPECT_LE(Scene().range(pixel.row, pixel.column), 2.4f);
  }
}

TEST(InterestPointsTest, ImagesWithoutMeasurementsHaveNone) {
  PixelGrid grid;
  grid.width = 20;
  grid.height = 10;
  grid.resolution = 0.01;
  RangeImage unseen(grid, Eigen::Isometry3d::Identity());
  RangeImage no_return = unseen;
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 20; ++column) no_return.SetNoReturn(row, column);
  for (const InterestMeasure measure : kMeasures) {
    EXPECT_TRUE(FindInterestPoints(RangeImage(), Params(measure)).empty());
    EXPECT_TRUE(FindInterestPoints(unseen, Params(measure)).empty());
    EXPECT_TRUE(FindInterestPoints(no_return, Params(measure)).empty());
  }
}

TEST(InterestPointsTest, TinyAndRandomImagesAreHarmless) {
  RandomValues random(1);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 7}, {7, 1}, {2, 2}, {3, 3}, {40, 30}}) {
    const RangeImage image = random.AnImage(width, height);
    for (const InterestMeasure measure : kMeasures) {
      const std::vector<PixelIndex> found = FindInterestPoints(image, Params(measure));
      EXPECT_LE(static_cast<int>(found.size()), image.CountMeasured());
      EXPECT_EQ(FindInterestPoints(image, Params(measure)), found);
    }
  }
}

TEST(InterestPointsTest, ThreadsAndOrderDoNotMatter) {
  const RangeImage image = RandomValues(32).AnImage(90, 70);
  for (const InterestMeasure measure :
       {InterestMeasure::kHarris, InterestMeasure::kSurfaceChange}) {
    const InterestPointParams params = Params(measure);
    const std::vector<PixelIndex> alone = FindInterestPoints(image, params);
    ASSERT_GT(alone.size(), 20u);
    for (const Execution& execution : {OnThreads(4), Backwards()}) {
      const std::vector<PixelIndex> other = FindInterestPoints(image, params, execution);
      ASSERT_EQ(other.size(), alone.size());
      for (std::size_t i = 0; i < alone.size(); ++i) {
        EXPECT_EQ(other[i].row, alone[i].row);
        EXPECT_EQ(other[i].column, alone[i].column);
      }
    }
  }
}

TEST(InterestPointParamsTest, KindTellsDifferentPointsApart) {
  const std::vector<std::function<void(InterestPointParams*)>> changes = {
      [](InterestPointParams* p) { p->measure = InterestMeasure::kSurfaceChange; },
      [](InterestPointParams* p) { p->max_points = 501; },
      [](InterestPointParams* p) { p->harris_window = 5; },
      [](InterestPointParams* p) { p->harris_k = 0.05; },
      [](InterestPointParams* p) { p->max_depth_jump = 0.4; },
      [](InterestPointParams* p) { p->bend_step = 0.06; },
      [](InterestPointParams* p) { p->min_strength = 2e-6; },
      [](InterestPointParams* p) { p->suppression_radius = 0.06; },
      [](InterestPointParams* p) { p->cube_side = 0.3; },
      [](InterestPointParams* p) { p->max_points_a_cube = 7; },
      [](InterestPointParams* p) { p->max_range = 2.0; },
  };
  const InterestPointParams params = Params(InterestMeasure::kHarris);
  EXPECT_EQ(Params(InterestMeasure::kHarris).Kind(), params.Kind());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    InterestPointParams changed = params;
    changes[i](&changed);
    EXPECT_NE(changed.Kind(), params.Kind()) << i;
  }
}

}  // namespace
}  // namespace rimod
