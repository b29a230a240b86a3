#include "rimod/descriptor_projection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "rimod/descriptor_index.h"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

// A patch of resolution x resolution cells: heights of a plane and a wave, plus noise, without its
// mean.
Descriptor RandomPatch(int resolution, int noise, RandomValues* random) {
  const double slope_x = random->Between(-80, 80), slope_y = random->Between(-80, 80);
  const double wave = random->Between(-300, 300), phase = random->Between(0, 6);
  std::vector<double> heights;
  double sum = 0.0;
  for (int row = 0; row < resolution; ++row) {
    for (int column = 0; column < resolution; ++column) {
      heights.push_back(slope_x * column + slope_y * row + wave * std::sin(0.4 * column + phase) +
                        random->Int(-noise, noise));
      sum += heights.back();
    }
  }
  Descriptor patch;
  for (const double height : heights)
    patch.push_back(
        static_cast<std::int16_t>(std::lround(height - sum / static_cast<double>(heights.size()))));
  return patch;
}

// Root of the summed squares, in kDescriptorUnit.
double Distance(const Descriptor& a, const Descriptor& b) {
  return DescriptorDistance(a, b, 1) / kDescriptorUnit * std::sqrt(static_cast<double>(a.size()));
}

TEST(DescriptorProjectionTest, AllFrequenciesKeepDistances) {
  RandomValues random(1);
  for (const int resolution : {2, 5, 8}) {
    const int all = resolution * resolution - 1;
    const DescriptorProjection projection(resolution, all);
    ASSERT_EQ(projection.dimensions(), all);
    for (int i = 0; i < 50; ++i) {
      const Descriptor a = RandomPatch(resolution, 200, &random);
      const Descriptor b = RandomPatch(resolution, 200, &random);
      EXPECT_NEAR(Distance(projection.Project(a), projection.Project(b)), Distance(a, b),
                  2.0 + 0.01 * Distance(a, b));
    }
  }
}

TEST(DescriptorProjectionTest, FewFrequenciesKeepMostOfSmoothPatches) {
  RandomValues random(2);
  const DescriptorProjection projection(8, 16);
  for (int i = 0; i < 200; ++i) {
    const Descriptor a = RandomPatch(8, 5, &random), b = RandomPatch(8, 5, &random);
    EXPECT_GT(Distance(projection.Project(a), projection.Project(b)), 0.9 * Distance(a, b) - 60);
  }
}

TEST(DescriptorProjectionTest, NeverMakesDistancesLarger) {
  RandomValues random(3);
  for (const int dimensions : {1, 4, 16}) {
    const DescriptorProjection projection(6, dimensions);
    for (int i = 0; i < 100; ++i) {
      const Descriptor a = RandomPatch(6, 300, &random), b = RandomPatch(6, 300, &random);
      EXPECT_LE(Distance(projection.Project(a), projection.Project(b)),
                Distance(a, b) + std::sqrt(dimensions));  // rounding
    }
  }
}

// By hand: of 2 x 2 cells the frequencies are up-down, left-right and the diagonal.
TEST(DescriptorProjectionTest, OfTwoTimesTwoCells) {
  const DescriptorProjection projection(2, 3);
  const Descriptor columns = projection.Project({100, -100, 100, -100});
  ASSERT_EQ(columns.size(), 3u);
  EXPECT_EQ(columns, (Descriptor{200, 0, 0}));
  EXPECT_EQ(projection.Project({100, 100, -100, -100}), (Descriptor{0, 200, 0}));
  EXPECT_EQ(projection.Project({100, -100, -100, 100}), (Descriptor{0, 0, 200}));
}

TEST(DescriptorProjectionTest, EmptyCellsStandAtTheMean) {
  const DescriptorProjection projection(3, 5);
  Descriptor with_hole{10, -20, 30, 0, 5, -6, 7, 8, -34}, with_zero = with_hole;
  with_hole[3] = kEmptyCell;
  EXPECT_EQ(projection.Project(with_hole), projection.Project(with_zero));
}

TEST(DescriptorProjectionTest, NeverMarksACellEmpty) {
  const DescriptorProjection projection(4, 6);
  for (const int sign : {-1, 1}) {
    Descriptor steep(16);
    for (int i = 0; i < 16; ++i)
      steep[i] = static_cast<std::int16_t>(sign * (i < 8 ? 32767 : -32767));
    for (const std::int16_t value : projection.Project(steep)) EXPECT_NE(value, kEmptyCell);
  }
}

TEST(DescriptorProjectionTest, TheWrongSizeGivesNothing) {
  EXPECT_TRUE(DescriptorProjection(2, 3).Project({1, 2}).empty());
  EXPECT_EQ(DescriptorProjection(2, 100).dimensions(), 3);
  for (const std::int16_t value : DescriptorProjection(2, 2).Project({0, 0, 0, 0}))
    EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace rimod
