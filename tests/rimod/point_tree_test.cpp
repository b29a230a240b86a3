#include "rimod/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/io/random_values.h"

namespace rimod {
namespace {

std::vector<Eigen::Vector3d> RandomPoints(int count, unsigned seed) {
  RandomValues random(seed);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    // Every third point is there twice.
    points.push_back(i % 3 == 2 ? points[i - 1] : random.Vector(1.0));
  }
  return points;
}

TEST(PointTreeTest, FindsWhatBruteForceFinds) {
  const std::vector<Eigen::Vector3d> points = RandomPoints(700, 1);
  const PointTree tree(points);
  RandomValues random(2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d query = i % 2 ? points[i] : random.Vector(1.5);
    const double radius = random.Between(0.0, 0.8);
    std::vector<int> within;
    std::vector<double> distances;
    for (std::size_t k = 0; k < points.size(); ++k) {
      distances.push_back((points[k] - query).norm());
      if (distances.back() < radius) within.push_back(static_cast<int>(k));
    }
    EXPECT_EQ(tree.Within(query, radius), within);
    std::sort(distances.begin(), distances.end());
    for (const int k : {1, 2, 5, 100, 700})
      EXPECT_NEAR(tree.DistanceToNearest(query, k), distances[k - 1], 1e-12);
  }
}

TEST(PointTreeTest, TheQueryCountsWhenItIsAPoint) {
  const PointTree tree({{0, 0, 0}, {1, 0, 0}});
  EXPECT_EQ(tree.DistanceToNearest({0, 0, 0}, 1), 0.0);
  EXPECT_EQ(tree.DistanceToNearest({0, 0, 0}, 2), 1.0);
}

TEST(PointTreeTest, ThereIsNoNeighbourBeyondTheLast) {
  const PointTree empty({});
  EXPECT_TRUE(empty.points().empty());
  EXPECT_TRUE(empty.Within({0, 0, 0}, 10.0).empty());
  EXPECT_TRUE(std::isinf(empty.DistanceToNearest({0, 0, 0}, 1)));
  const PointTree one({{1, 2, 3}});
  EXPECT_EQ(one.Within({1, 2, 3}, 0.1), std::vector<int>{0});
  EXPECT_TRUE(std::isinf(one.DistanceToNearest({1, 2, 3}, 2)));
}

TEST(PointTreeTest, ManyDuplicatesAndCollinearPointsAreHarmless) {
  const PointTree same(std::vector<Eigen::Vector3d>(500, Eigen::Vector3d(1, 1, 1)));
  EXPECT_EQ(same.Within({1, 1, 1}, 0.01).size(), 500u);
  EXPECT_EQ(same.DistanceToNearest({1, 1, 2}, 500), 1.0);
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i < 300; ++i) line.push_back({0.01 * i, 0.0, 0.0});
  EXPECT_EQ(PointTree(line).Within({1.0, 0.0, 0.0}, 0.0251).size(), 5u);
}

TEST(PointTreeTest, CanBeMoved) {
  PointTree first(RandomPoints(50, 3));
  const std::vector<int> before = first.Within({0, 0, 0}, 0.7);
  PointTree second(std::move(first));
  EXPECT_EQ(second.Within({0, 0, 0}, 0.7), before);
  PointTree third({});
  third = std::move(second);
  EXPECT_EQ(third.Within({0, 0, 0}, 0.7), before);
  EXPECT_EQ(third.points().size(), 50u);
}

}  // namespace
}  // namespace rimod
