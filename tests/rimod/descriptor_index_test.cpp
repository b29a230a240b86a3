#include "rimod/descriptor_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/io/random_values.h"
#include "tests/support/executions.h"

namespace rimod {
namespace {

constexpr double kAnyDistance = 1e6;

// Values of a few centimetres; each cell empty with the given probability.
Descriptor RandomDescriptor(RandomValues* random, int size, double empty_share = 0.0) {
  Descriptor descriptor;
  for (int i = 0; i < size; ++i) {
    const bool empty = random->Between(0.0, 1.0) < empty_share;
    descriptor.push_back(empty ? kEmptyCell : static_cast<std::int16_t>(random->Int(-500, 500)));
  }
  return descriptor;
}

std::vector<Descriptor> RandomDescriptors(int count, int size, unsigned seed,
                                          double empty_share = 0.0) {
  RandomValues random(seed);
  std::vector<Descriptor> descriptors;
  for (int i = 0; i < count; ++i)
    descriptors.push_back(RandomDescriptor(&random, size, empty_share));
  return descriptors;
}

std::vector<const Descriptor*> Pointers(const std::vector<Descriptor>& descriptors) {
  std::vector<const Descriptor*> pointers;
  for (const Descriptor& descriptor : descriptors) pointers.push_back(&descriptor);
  return pointers;
}

// Root mean square difference, empty cells standing at the mean.
double FilledDistance(const Descriptor& a, const Descriptor& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double va = a[i] == kEmptyCell ? 0.0 : a[i] * kDescriptorUnit;
    const double vb = b[i] == kEmptyCell ? 0.0 : b[i] * kDescriptorUnit;
    sum += (va - vb) * (va - vb);
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

std::vector<double> SortedDistances(const std::vector<Descriptor>& descriptors,
                                    const Descriptor& query) {
  std::vector<double> distances;
  for (const Descriptor& descriptor : descriptors)
    distances.push_back(FilledDistance(descriptor, query));
  std::sort(distances.begin(), distances.end());
  return distances;
}

TEST(DescriptorDistanceTest, IsTheRootMeanSquareInMetres) {
  EXPECT_DOUBLE_EQ(DescriptorDistance({0, 0, 0, 0}, {300, 400, 0, 0}, 1), 0.025);
  EXPECT_EQ(DescriptorDistance({5, -7}, {5, -7}, 1), 0.0);
}

TEST(DescriptorDistanceTest, LeavesOutEmptyCells) {
  EXPECT_DOUBLE_EQ(DescriptorDistance({100, kEmptyCell, 50}, {0, 900, kEmptyCell}, 1), 0.01);
}

TEST(DescriptorDistanceTest, IsInfiniteForTooFewSharedCells) {
  const Descriptor a{1, 2, kEmptyCell, 4}, b{1, 2, 3, kEmptyCell};
  EXPECT_EQ(DescriptorDistance(a, b, 2), 0.0);
  EXPECT_TRUE(std::isinf(DescriptorDistance(a, b, 3)));
  const Descriptor empty(4, kEmptyCell);
  EXPECT_TRUE(std::isinf(DescriptorDistance(empty, empty, 0)));
}

TEST(DescriptorDistanceTest, IsSymmetricAndSurvivesExtremeValues) {
  RandomValues random(1);
  for (int i = 0; i < 100; ++i) {
    const Descriptor a = RandomDescriptor(&random, 64, 0.3), b = RandomDescriptor(&random, 64, 0.3);
    EXPECT_EQ(DescriptorDistance(a, b, 1), DescriptorDistance(b, a, 1));
  }
  const Descriptor low(64, -32767), high(64, 32767);
  EXPECT_NEAR(DescriptorDistance(low, high, 1), 6.5534, 1e-9);
}

TEST(DescriptorIndexTest, LookingAtAllIsExact) {
  for (const double empty_share : {0.0, 0.4}) {
    const std::vector<Descriptor> descriptors = RandomDescriptors(600, 9, 2, empty_share);
    const DescriptorIndex index(Pointers(descriptors));
    RandomValues random(3);
    for (int i = 0; i < 60; ++i) {
      const Descriptor query = RandomDescriptor(&random, 9, empty_share);
      const std::vector<double> expected = SortedDistances(descriptors, query);
      const std::vector<DescriptorMatch> found = index.FindNear(query, 25, kAnyDistance, 600);
      ASSERT_EQ(found.size(), 25u);
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_NEAR(found[k].distance, expected[k], 1e-7);
        EXPECT_NEAR(FilledDistance(descriptors[found[k].index], query), found[k].distance, 1e-7);
      }
    }
  }
}

TEST(DescriptorIndexTest, KeepsToTheMaximumDistance) {
  const std::vector<Descriptor> descriptors = RandomDescriptors(500, 8, 4);
  const DescriptorIndex index(Pointers(descriptors));
  RandomValues random(5);
  for (const double max_distance : {0.0, 0.01, 0.025, 0.03}) {
    const Descriptor query = RandomDescriptor(&random, 8);
    const std::vector<double> all = SortedDistances(descriptors, query);
    const auto expected = std::upper_bound(all.begin(), all.end(), max_distance) - all.begin();
    EXPECT_EQ(static_cast<std::ptrdiff_t>(index.FindNear(query, 500, max_distance, 500).size()),
              expected);
  }
}

TEST(DescriptorIndexTest, FewChecksGiveTrueMatchesInOrder) {
  const std::vector<Descriptor> descriptors = RandomDescriptors(2000, 16, 6);
  const DescriptorIndex index(Pointers(descriptors));
  RandomValues random(7);
  double nearest_sum = 0.0, exact_sum = 0.0;
  for (int i = 0; i < 50; ++i) {
    const Descriptor query = RandomDescriptor(&random, 16);
    const double exact = SortedDistances(descriptors, query).front();
    double before = std::numeric_limits<double>::infinity();
    for (const int checks : {1, 20, 200, 2000}) {
      const std::vector<DescriptorMatch> found = index.FindNear(query, 2000, kAnyDistance, checks);
      ASSERT_GE(static_cast<int>(found.size()), checks);
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_NEAR(FilledDistance(descriptors[found[k].index], query), found[k].distance, 1e-7);
        EXPECT_LE(found[std::max<std::size_t>(k, 1) - 1].distance, found[k].distance);
      }
      // More checks never lose the best.
      EXPECT_LE(found.front().distance, before);
      before = found.front().distance;
      if (checks == 200) nearest_sum += before, exact_sum += exact;
    }
    EXPECT_NEAR(before, exact, 1e-7);
  }
  EXPECT_LT(nearest_sum, 1.25 * exact_sum);  // a tenth of the checks finds nearly as near ones
}

TEST(DescriptorIndexTest, NoDescriptorIsFoundTwice) {
  const std::vector<Descriptor> descriptors = RandomDescriptors(333, 4, 8);
  const std::vector<DescriptorMatch> found =
      DescriptorIndex(Pointers(descriptors)).FindNear(descriptors[0], 1000, kAnyDistance, 1000);
  std::vector<int> indices;
  for (const DescriptorMatch& match : found) indices.push_back(match.index);
  std::sort(indices.begin(), indices.end());
  ASSERT_EQ(indices.size(), 333u);
  for (int i = 0; i < 333; ++i) EXPECT_EQ(indices[i], i);
}

TEST(DescriptorIndexTest, EqualInputGivesEqualAnswers) {
  const std::vector<Descriptor> descriptors = RandomDescriptors(900, 12, 9);
  const DescriptorIndex one(Pointers(descriptors)), two(Pointers(descriptors));
  RandomValues random(10);
  for (int i = 0; i < 50; ++i) {
    const Descriptor query = RandomDescriptor(&random, 12);
    const auto a = one.FindNear(query, 10, kAnyDistance, 60);
    const auto b = two.FindNear(query, 10, kAnyDistance, 60);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_EQ(a[k].index, b[k].index);
      EXPECT_EQ(a[k].distance, b[k].distance);
    }
  }
}

TEST(DescriptorIndexTest, IsTheSameOnAnyThreadsAndFromOneList) {
  const int size = 6, count = 3000;  // more pieces than are built level by level
  const std::vector<Descriptor> descriptors = RandomDescriptors(count, size, 13);
  std::vector<std::int16_t> values;
  for (const Descriptor& descriptor : descriptors)
    values.insert(values.end(), descriptor.begin(), descriptor.end());
  const DescriptorIndex expected(Pointers(descriptors));
  const DescriptorIndex threaded(values, size, OnThreads(3));
  const DescriptorIndex backwards(values, size, Backwards());
  RandomValues random(14);
  for (int i = 0; i < 50; ++i) {
    const Descriptor query = RandomDescriptor(&random, size);
    const auto found = expected.FindNear(query, 10, kAnyDistance, 100);
    for (const DescriptorIndex* other : {&threaded, &backwards}) {
      const auto same = other->FindNear(query, 10, kAnyDistance, 100);
      ASSERT_EQ(same.size(), found.size());
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(same[k].index, found[k].index);
        EXPECT_EQ(same[k].distance, found[k].distance);
      }
    }
  }
}

TEST(DescriptorIndexTest, EveryValueStandsForTheNearestFloatInMetres) {
  for (int value = -32767; value <= 32767; ++value) {
    const Descriptor descriptor{static_cast<std::int16_t>(value)};
    const auto found = DescriptorIndex({&descriptor}).FindNear({0}, 1, kAnyDistance, 1);
    ASSERT_EQ(found.size(), 1u);
    const float metres = static_cast<float>(value * kDescriptorUnit);
    ASSERT_EQ(found[0].distance, std::sqrt(static_cast<double>(metres * metres))) << value;
  }
}

TEST(DescriptorIndexTest, ExtremeValuesAreComparedToo) {
  const std::vector<Descriptor> descriptors = {Descriptor(16, -32767), Descriptor(16, 32767),
                                               Descriptor(16, 0)};
  const DescriptorIndex index(Pointers(descriptors));
  const auto found = index.FindNear(Descriptor(16, 32766), 3, kAnyDistance, 3);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].index, 1);
  EXPECT_EQ(found[1].index, 2);
  EXPECT_NEAR(found[2].distance, 6.5533, 1e-5);
}

TEST(DescriptorIndexTest, RefusesValuesThatMakeNoWholeDescriptors) {
  EXPECT_THROW(DescriptorIndex({1, 2, 3}, 2, Execution{}), std::invalid_argument);
  EXPECT_THROW(DescriptorIndex(std::vector<std::int16_t>(), 0, Execution{}), std::invalid_argument);
}

TEST(DescriptorIndexTest, TiesAreInOrderOfIndex) {
  const std::vector<Descriptor> descriptors(100, Descriptor{1, 2, 3});
  const std::vector<DescriptorMatch> found =
      DescriptorIndex(Pointers(descriptors)).FindNear({1, 2, 3}, 100, 0.1, 100);
  ASSERT_EQ(found.size(), 100u);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(found[i].index, i);
}

TEST(DescriptorIndexTest, ComparesOverSharedCellsWhenTold) {
  const std::vector<Descriptor> descriptors = RandomDescriptors(400, 12, 11, 0.4);
  const DescriptorIndex index(Pointers(descriptors));
  RandomValues random(12);
  for (const int min_shared : {1, 4, 8}) {
    const Descriptor query = RandomDescriptor(&random, 12, 0.4);
    std::vector<double> expected;
    for (const Descriptor& descriptor : descriptors) {
      const double distance = DescriptorDistance(descriptor, query, min_shared);
      if (std::isfinite(distance)) expected.push_back(distance);
    }
    std::sort(expected.begin(), expected.end());
    const std::vector<DescriptorMatch> found =
        index.FindNear(query, 400, kAnyDistance, 400, min_shared);
    ASSERT_EQ(found.size(), expected.size()) << min_shared;
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_NEAR(found[k].distance, expected[k], 1e-7);
  }
}

TEST(DescriptorIndexTest, NothingToFindIsNothing) {
  const DescriptorIndex empty({});
  EXPECT_EQ(empty.size(), 0);
  EXPECT_TRUE(empty.FindNear({1, 2}, 5, kAnyDistance, 5).empty());
  EXPECT_TRUE(empty.FindNear({}, 5, kAnyDistance, 5).empty());
  const std::vector<Descriptor> one{{1, 2}};
  const DescriptorIndex index(Pointers(one));
  EXPECT_EQ(index.size(), 1);
  EXPECT_TRUE(index.FindNear({1, 2, 3}, 5, kAnyDistance, 5).empty());
  EXPECT_TRUE(index.FindNear({1, 2}, 0, kAnyDistance, 5).empty());
  EXPECT_EQ(index.FindNear({1, 2}, 5, 0.0, 5).size(), 1u);
}

}  // namespace
}  // namespace rimod
