#include "rimod/descriptor_projection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "rimod/descriptor_index.h"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

// Descriptors of this size that are sums of few patterns, plus a little noise.
std::vector<Descriptor> PatternedDescriptors(int count, int size, int patterns, int noise,
                                             unsigned seed) {
  RandomValues random(seed);
  std::vector<std::vector<double>> bases(patterns);
  for (std::vector<double>& basis : bases)
    for (int i = 0; i < size; ++i) basis.push_back(random.Between(-300, 300));
  std::vector<Descriptor> descriptors(count);
  for (Descriptor& descriptor : descriptors) {
    std::vector<double> values(size, 0.0);
    for (const std::vector<double>& basis : bases) {
      const double weight = random.Between(-1, 1);
      for (int i = 0; i < size; ++i) values[i] += weight * basis[i];
    }
    for (const double value : values)
      descriptor.push_back(
          static_cast<std::int16_t>(std::lround(value) + random.Int(-noise, noise)));
  }
  return descriptors;
}

std::vector<const Descriptor*> Pointers(const std::vector<Descriptor>& descriptors) {
  std::vector<const Descriptor*> pointers;
  for (const Descriptor& descriptor : descriptors) pointers.push_back(&descriptor);
  return pointers;
}

// Root of the summed squares, in kDescriptorUnit.
double Distance(const Descriptor& a, const Descriptor& b) {
  return DescriptorDistance(a, b, 1) / kDescriptorUnit * std::sqrt(static_cast<double>(a.size()));
}

TEST(DescriptorProjectionTest, AllDimensionsKeepDistances) {
  const std::vector<Descriptor> descriptors = PatternedDescriptors(60, 12, 12, 0, 1);
  const DescriptorProjection projection(Pointers(descriptors), 12);
  for (int i = 0; i < 59; ++i) {
    const Descriptor a = projection.Project(descriptors[i]);
    const Descriptor b = projection.Project(descriptors[i + 1]);
    ASSERT_EQ(a.size(), 12u);
    EXPECT_NEAR(Distance(a, b), Distance(descriptors[i], descriptors[i + 1]), 4.0);
  }
}

TEST(DescriptorProjectionTest, AsManyDimensionsAsPatternsKeepDistances) {
  const std::vector<Descriptor> descriptors = PatternedDescriptors(200, 40, 5, 2, 2);
  const DescriptorProjection projection(Pointers(descriptors), 5);
  for (int i = 0; i < 199; ++i) {
    const Descriptor a = projection.Project(descriptors[i]);
    const Descriptor b = projection.Project(descriptors[i + 1]);
    ASSERT_EQ(a.size(), 5u);
    EXPECT_NEAR(Distance(a, b), Distance(descriptors[i], descriptors[i + 1]), 20.0);
  }
}

TEST(DescriptorProjectionTest, NeverMakesDistancesLarger) {
  const std::vector<Descriptor> descriptors = PatternedDescriptors(100, 30, 30, 50, 3);
  for (const int dimensions : {1, 4, 16}) {
    const DescriptorProjection projection(Pointers(descriptors), dimensions);
    for (int i = 0; i < 99; ++i) {
      const double before = Distance(descriptors[i], descriptors[i + 1]);
      EXPECT_LE(
          Distance(projection.Project(descriptors[i]), projection.Project(descriptors[i + 1])),
          before + std::sqrt(dimensions));  // rounding
    }
  }
}

TEST(DescriptorProjectionTest, EmptyCellsStandAtTheMean) {
  std::vector<Descriptor> descriptors = PatternedDescriptors(50, 8, 8, 0, 4);
  const DescriptorProjection projection(Pointers(descriptors), 8);
  Descriptor with_hole = descriptors[0], with_zero = descriptors[0];
  with_hole[3] = kEmptyCell;
  with_zero[3] = 0;
  EXPECT_EQ(projection.Project(with_hole), projection.Project(with_zero));
}

TEST(DescriptorProjectionTest, IsTheSameEveryTimeAndNeverMarksACellEmpty) {
  const std::vector<Descriptor> descriptors = PatternedDescriptors(80, 10, 10, 0, 5);
  const DescriptorProjection one(Pointers(descriptors), 6), two(Pointers(descriptors), 6);
  for (const Descriptor& descriptor : descriptors)
    EXPECT_EQ(one.Project(descriptor), two.Project(descriptor));
  for (const std::int16_t value : one.Project(Descriptor(10, -32767))) EXPECT_NE(value, kEmptyCell);
  for (const std::int16_t value : one.Project(Descriptor(10, 32767))) EXPECT_NE(value, kEmptyCell);
}

TEST(DescriptorProjectionTest, DegenerateInputGivesNothingOrLittle) {
  EXPECT_TRUE(DescriptorProjection({}, 5).Project({1, 2, 3}).empty());
  const std::vector<Descriptor> one{{10, 20, 30}};
  EXPECT_TRUE(DescriptorProjection(Pointers(one), 2).Project({1, 2}).empty());
  EXPECT_EQ(DescriptorProjection(Pointers(one), 9).Project({1, 2, 3}).size(), 3u);
  const std::vector<Descriptor> flat(20, Descriptor(4, 0));
  for (const std::int16_t value : DescriptorProjection(Pointers(flat), 2).Project({0, 0, 0, 0}))
    EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace rimod
