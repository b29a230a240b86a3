#include "rimod/spherical_spin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "rimod/descriptor_index.h"
#include "rimod/feature_extraction.h"
#include "tests/io/random_values.h"
#include "tests/support/executions.h"
#include "tests/support/ray_caster.h"

namespace rimod {
namespace {

using Points = std::vector<Eigen::Vector3f>;

const Eigen::Vector3f kOrigin = Eigen::Vector3f::Zero(), kUp = Eigen::Vector3f::UnitZ();

SphericalSpinParams Params() {
  SphericalSpinParams params;
  params.resolution = 5;
  params.support_size = 0.6;
  params.dimensions = 0;
  params.normal_radius = 0.06;
  params.normal_pixels = 0.0;
  params.min_points = 8;
  return params;
}

Points RandomCloud(int count, RandomValues* random) {
  Points points;
  for (int i = 0; i < count; ++i) points.push_back(random->Vector(0.4).cast<float>());
  return points;
}

Points Moved(const Eigen::Isometry3d& T, const Points& points) {
  Points moved;
  for (const Eigen::Vector3f& p : points) moved.push_back((T * p.cast<double>()).cast<float>());
  return moved;
}

// Floats are rounded when clouds move: half a step of a descriptor and a little.
void ExpectSame(const std::optional<Descriptor>& a, const std::optional<Descriptor>& b) {
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->size(), b->size());
  for (std::size_t i = 0; i < a->size(); ++i) EXPECT_LE(std::abs((*a)[i] - (*b)[i]), 3) << i;
}

// 2 x 2 bins of a cylinder 0.8 m wide and high: 0.2 m of distance and 0.4 m of height each.
TEST(SphericalSpinImageTest, AsComputedByHand) {
  SphericalSpinParams params = Params();
  params.resolution = 2;
  params.support_size = 0.8;
  // Three points in the middle of the upper outer bin, one a quarter on the way from there to the
  // upper inner bin, one amidst all four: counts 0.25 + 0.25, 3 + 0.75 + 0.25; 0.25, 0.25.
  const Points points = {
      {0.3f, 0, 0.2f}, {0, -0.3f, 0.2f}, {-0.18f, 0.24f, 0.2f}, {0, 0.25f, 0.2f}, {0.2f, 0, 0}};
  const std::optional<Descriptor> image = SphericalSpinImage(points, kOrigin, kUp, params);
  ASSERT_TRUE(image);
  ASSERT_EQ(image->size(), 4u);
  // Mean 1.25, squares 0.75^2 + 2.75^2 + 2 * 1^2 = 10.125, standard deviation 1.59099.
  const double counts[4] = {0.5, 4.0, 0.25, 0.25};
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR((*image)[i] * kDescriptorUnit, 0.2 * (counts[i] - 1.25) / 1.59099, 2e-4) << i;
}

TEST(SphericalSpinImageTest, NearTheNormalAPointIsInTheFirstColumnAlone) {
  const std::optional<Descriptor> image =
      SphericalSpinImage({{0.001f, 0, 0}, {0, 0, 0}}, kOrigin, kUp, Params());
  ASSERT_TRUE(image);
  for (int i = 0; i < 25; ++i) {
    if (i == 10) {
      EXPECT_GT((*image)[i], 0);
    } else {
      EXPECT_LT((*image)[i], 0) << i;
    }
  }
}

TEST(SphericalSpinImageTest, IsOnTheSphere) {
  RandomValues random(1);
  for (int resolution = 2; resolution <= 16; ++resolution) {
    SphericalSpinParams params = Params();
    params.resolution = resolution;
    // One point, too: the largest value that there can be.
    for (const int count : {1, 300}) {
      Points points = {kOrigin};
      if (count > 1) points = RandomCloud(count, &random);
      const std::optional<Descriptor> image = SphericalSpinImage(points, kOrigin, kUp, params);
      ASSERT_TRUE(image);
      double sum = 0.0, sum_sq = 0.0;
      for (const std::int16_t value : *image) {
        EXPECT_NE(value, kEmptyCell);
        sum += value * kDescriptorUnit;
        sum_sq += value * kDescriptorUnit * value * kDescriptorUnit;
      }
      const double size = resolution * resolution;
      EXPECT_NEAR(sum / size, 0.0, 1e-4);
      EXPECT_NEAR(std::sqrt(sum_sq / size), kSpinSpread, 2e-4) << resolution;
    }
  }
}

TEST(SphericalSpinImageTest, TurningTheCloudAboutTheNormalChangesNothing) {
  RandomValues random(2);
  for (int i = 0; i < 50; ++i) {
    const Points points = RandomCloud(200, &random);
    const Eigen::Vector3d normal = random.Unit();
    const Eigen::Vector3f p = random.Vector(0.1).cast<float>();
    const Eigen::Isometry3d turn = Eigen::Translation3d(p.cast<double>()) *
                                   Eigen::AngleAxisd(random.Between(-M_PI, M_PI), normal) *
                                   Eigen::Translation3d(-p.cast<double>());
    const Eigen::Vector3f n = normal.cast<float>();
    ExpectSame(SphericalSpinImage(points, p, n, Params()),
               SphericalSpinImage(Moved(turn, points), p, n, Params()));
  }
}

TEST(SphericalSpinImageTest, MovesWithTheCloud) {
  RandomValues random(3);
  for (int i = 0; i < 50; ++i) {
    const Points points = RandomCloud(200, &random);
    const Eigen::Vector3d normal = random.Unit();
    Eigen::Isometry3d T = random.Pose();
    T.translation() *= 0.1;  // floats are finer there
    ExpectSame(SphericalSpinImage(points, kOrigin, normal.cast<float>(), Params()),
               SphericalSpinImage(Moved(T, points), T.translation().cast<float>(),
                                  (T.linear() * normal).cast<float>(), Params()));
  }
}

// What spin images cannot tell apart.
TEST(SphericalSpinImageTest, OfTheMirroredCloudIsTheSame) {
  RandomValues random(4);
  for (int i = 0; i < 50; ++i) {
    const Points points = RandomCloud(200, &random);
    const Eigen::Vector3f across =
        Eigen::AngleAxisf(static_cast<float>(random.Between(0, 6)), kUp) * Eigen::Vector3f::UnitX();
    Points mirrored;
    for (const Eigen::Vector3f& p : points) mirrored.push_back(p - 2.0f * p.dot(across) * across);
    ExpectSame(SphericalSpinImage(points, kOrigin, kUp, Params()),
               SphericalSpinImage(mirrored, kOrigin, kUp, Params()));
  }
}

TEST(SphericalSpinImageTest, TurningTheNormalOverTurnsRowsOver) {
  RandomValues random(5);
  const Points points = RandomCloud(300, &random);
  const std::optional<Descriptor> image = SphericalSpinImage(points, kOrigin, kUp, Params());
  std::optional<Descriptor> over = SphericalSpinImage(points, kOrigin, -kUp, Params());
  ASSERT_TRUE(image && over);
  for (int row = 0; row < 2; ++row)
    std::swap_ranges(&(*over)[5 * row], &(*over)[5 * row] + 5, &(*over)[5 * (4 - row)]);
  ExpectSame(image, over);
}

// The density of points is that of the sensor, not of the surface.
TEST(SphericalSpinImageTest, EachPointTwiceIsTheSame) {
  RandomValues random(6);
  const Points points = RandomCloud(100, &random);
  Points twice = points;
  twice.insert(twice.end(), points.begin(), points.end());
  ExpectSame(SphericalSpinImage(points, kOrigin, kUp, Params()),
             SphericalSpinImage(twice, kOrigin, kUp, Params()));
}

// The reason for the sphere: nearest is best correlated.
TEST(SphericalSpinImageTest, DistancesAreThoseOfTheCorrelation) {
  RandomValues random(7);
  for (int i = 0; i < 50; ++i) {
    const std::optional<Descriptor> a =
        SphericalSpinImage(RandomCloud(40, &random), kOrigin, kUp, Params());
    const std::optional<Descriptor> b =
        SphericalSpinImage(RandomCloud(40, &random), kOrigin, kUp, Params());
    ASSERT_TRUE(a && b);
    double product = 0.0, a_sq = 0.0, b_sq = 0.0;
    for (std::size_t k = 0; k < a->size(); ++k) {
      product += static_cast<double>((*a)[k]) * (*b)[k];
      a_sq += static_cast<double>((*a)[k]) * (*a)[k];
      b_sq += static_cast<double>((*b)[k]) * (*b)[k];
    }
    const double r = product / std::sqrt(a_sq * b_sq);
    EXPECT_NEAR(DescriptorDistance(*a, *b, 1), kSpinSpread * std::sqrt(2.0 * (1.0 - r)), 2e-4);
  }
}

TEST(SphericalSpinImageTest, PointsThatAreNoNumberOrOutsideDoNotCount) {
  RandomValues random(8);
  const Points points = RandomCloud(100, &random);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  Points more = points;
  for (const float bad : {nan, infinite, -infinite, 1e30f, -1e30f})
    for (int axis = 0; axis < 3; ++axis)
      more.push_back(0.1f * kUp + bad * Eigen::Vector3f::Unit(axis));
  more.insert(more.begin(), {0, 0, 0.37f});   // farther than half a bin above ..
  more.insert(more.begin(), {0, 0, -0.37f});  // .. below ..
  more.insert(more.begin(), {0.34f, 0, 0});   // .. and outside
  EXPECT_EQ(SphericalSpinImage(points, kOrigin, kUp, Params()),
            SphericalSpinImage(more, kOrigin, kUp, Params()));
}

TEST(SphericalSpinImageTest, NothingOfNothing) {
  EXPECT_FALSE(SphericalSpinImage({}, kOrigin, kUp, Params()));
  EXPECT_FALSE(SphericalSpinImage({{5, 5, 5}}, kOrigin, kUp, Params()));
  const Eigen::Vector3f nan = Eigen::Vector3f::Constant(std::nanf(""));
  EXPECT_FALSE(SphericalSpinImage({kOrigin}, nan, kUp, Params()));
  EXPECT_FALSE(SphericalSpinImage({kOrigin}, kOrigin, nan, Params()));
}

// A ball before a wall.
RangeImage BallImage(bool with_wall = true) {
  World world;
  if (with_wall) world.planes = {{{2.3, 0, 0}, Eigen::Vector3d(1, 0.2, 0.1).normalized()}};
  world.spheres = {{Eigen::Vector3d(2.0, 0.05, 0.0), 0.15}};
  BeamPattern pattern;
  pattern.azimuth_min = pattern.elevation_min = -0.25;
  pattern.azimuth_max = pattern.elevation_max = 0.25;
  pattern.step = 0.005;
  RangeImageParams params;
  params.resolution = pattern.step;
  return MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), pattern), params);
}

PixelIndex Middle(const RangeImage& image) { return {image.height() / 2, image.width() / 2}; }

TEST(SphericalSpinDescriberTest, DescribesAllMeasuredPointsAround) {
  const RangeImage image = BallImage();
  SphericalSpinParams params = Params();
  params.support_size = 0.1;  // no wider than is looked at pixel by pixel
  const std::optional<Feature> feature = SphericalSpinDescriber(params)(image, Middle(image));
  ASSERT_TRUE(feature);
  EXPECT_LT(feature->normal.x(), -0.9f);
  Points points;
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column)
      if (image.measured(row, column)) points.push_back(image.point(row, column));
  const std::optional<Descriptor> expected =
      SphericalSpinImage(points, feature->position, feature->normal, params);
  ASSERT_TRUE(expected);
  EXPECT_EQ(feature->descriptor, *expected);
}

TEST(SphericalSpinDescriberTest, NothingWithoutANormal) {
  PixelGrid grid;
  grid.width = grid.height = 9;
  grid.resolution = 0.01;
  RangeImage image(grid, Eigen::Isometry3d::Identity());
  image.SetMeasured(4, 4, {1600, 0, 0});
  EXPECT_FALSE(SphericalSpinDescriber(Params())(image, {4, 4}));
}

TEST(SphericalSpinDescriberTest, CompressedDistancesAreAtMostAndNearlyThoseOfTheImages) {
  const RangeImage image = BallImage();
  SphericalSpinParams whole = Params();
  whole.resolution = 8;
  SphericalSpinParams few = whole;
  few.dimensions = 20;
  EXPECT_EQ(whole.DescriptorSize(), 64);
  EXPECT_EQ(few.DescriptorSize(), 20);
  const SphericalSpinDescriber describe_whole(whole), describe_few(few);
  std::vector<std::optional<Feature>> a, b;
  for (int column = 20; column < image.width() - 20; column += 7) {
    if (!image.measured(image.height() / 2, column)) continue;
    a.push_back(describe_whole(image, {image.height() / 2, column}));
    b.push_back(describe_few(image, {image.height() / 2, column}));
    ASSERT_TRUE(a.back() && b.back());
    EXPECT_EQ(b.back()->descriptor.size(), 20u);
  }
  ASSERT_GE(a.size(), 5u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double full = DescriptorDistance(a[i]->descriptor, a[j]->descriptor, 1);
      const double compressed = DescriptorDistance(b[i]->descriptor, b[j]->descriptor, 1);
      EXPECT_LE(compressed, full + 2e-4);
      EXPECT_GE(compressed, 0.5 * full - 2e-4);
    }
  }
}

TEST(SphericalSpinDescriberTest, AllFrequenciesKeepAllOfTheDistance) {
  const RangeImage image = BallImage();
  SphericalSpinParams all = Params();
  all.dimensions = 255;
  EXPECT_EQ(all.DescriptorSize(), 24);  // the constant part is zero
  const SphericalSpinDescriber describe(Params()), describe_all(all);
  const PixelIndex p{image.height() / 2, 40}, q{image.height() / 2, 60};
  EXPECT_NEAR(
      DescriptorDistance(describe(image, p)->descriptor, describe(image, q)->descriptor, 1),
      DescriptorDistance(describe_all(image, p)->descriptor, describe_all(image, q)->descriptor, 1),
      2e-4);
}

TEST(SphericalSpinParamsTest, KindNamesWhatTheDescriptorDependsOn) {
  std::vector<SphericalSpinParams> all(7, Params());
  all[1].resolution = 6;
  all[2].support_size = 0.61;
  all[3].dimensions = 12;
  all[4].normal_radius = 0.07;
  all[5].normal_pixels = 1.0;
  all[6].min_points = 9;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(all[i].Kind(), all[j].Kind()) << i << ' ' << j;
  EXPECT_NE(Params().Kind(), RangePatchParams().Kind());
}

TEST(ExtractFeaturesTest, OfSphericalSpinImagesAtAnyThreadCount) {
  PipelineParams params;
  params.method = Method::kPaper;
  params.descriptor = DescriptorType::kSphericalSpin;
  params.spherical_spin = Params();
  params.interest_points.max_points = 200;
  params.interest_points.suppression_radius = 0.02;
  const RangeImage image = BallImage();
  const FeatureSet alone = ExtractFeatures(image, params, Execution{});
  EXPECT_EQ(alone.descriptor_kind, Params().Kind());
  EXPECT_EQ(alone.descriptor_size, 25);
  ASSERT_GT(alone.features.size(), 10u);
  for (const Execution& execution : {OnThreads(4), Backwards()}) {
    const FeatureSet other = ExtractFeatures(image, params, execution);
    ASSERT_EQ(other.features.size(), alone.features.size());
    for (std::size_t i = 0; i < alone.features.size(); ++i) {
      EXPECT_EQ(other.features[i].descriptor, alone.features[i].descriptor);
      EXPECT_EQ(other.features[i].descriptor.size(), 25u);
    }
  }
}

}  // namespace
}  // namespace rimod
