#include "rimod/surface_thinning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rimod {
namespace {

ObjectModel RandomSurface(unsigned seed, int count) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> coordinate(-0.3f, 0.3f);
  ObjectModel model;
  model.name = "cloud";
  model.box_min.setConstant(-0.3);
  model.box_max.setConstant(0.3);
  model.point_spacing = 0.01;
  for (int i = 0; i < count; ++i) {
    model.points.emplace_back(coordinate(generator), coordinate(generator), coordinate(generator));
    model.normals.push_back(
        Eigen::Vector3f(coordinate(generator), coordinate(generator), coordinate(generator))
            .normalized());
  }
  return model;
}

bool SameCell(const Eigen::Vector3f& a, const Eigen::Vector3f& b, double spacing) {
  for (int d = 0; d < 3; ++d)
    if (std::lround(static_cast<double>(a[d]) / spacing) !=
        std::lround(static_cast<double>(b[d]) / spacing))
      return false;
  return true;
}

TEST(SurfaceThinningTest, KeepsTheFirstOfEachCellAndSide) {
  for (const double spacing : {0.02, 0.05, 0.2}) {
    const ObjectModel model = RandomSurface(1, 2000);
    const ObjectModel thin = ThinSurface(model, spacing);
    // Brute force: a point stays unless an earlier one that stayed has its cell and side.
    std::vector<Eigen::Vector3f> points, normals;
    for (std::size_t i = 0; i < model.points.size(); ++i) {
      bool known = false;
      for (std::size_t k = 0; k < points.size(); ++k)
        known = known || (SameCell(points[k], model.points[i], spacing) &&
                          normals[k].dot(model.normals[i]) > 0.5f);
      if (known) continue;
      points.push_back(model.points[i]);
      normals.push_back(model.normals[i]);
    }
    EXPECT_EQ(thin.points, points) << spacing;
    EXPECT_EQ(thin.normals, normals) << spacing;
    EXPECT_EQ(thin.point_spacing, spacing);
  }
}

TEST(SurfaceThinningTest, BothSidesOfASheetStay) {
  ObjectModel model;
  model.points = {{0, 0, 0}, {0.001f, 0, 0}, {0, 0.001f, 0}};
  model.normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, 1}};
  const ObjectModel thin = ThinSurface(model, 0.05);
  ASSERT_EQ(thin.points.size(), 2u);
  EXPECT_EQ(thin.normals[1], Eigen::Vector3f(0, 0, -1));
}

TEST(SurfaceThinningTest, FarPointsAndTinyCellsAreHarmless) {
  ObjectModel model;
  model.points = {{1000, -1000, 1000}, {1000, -1000, 1000}, {-1000, 1000, 0}};
  model.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  EXPECT_EQ(ThinSurface(model, 1e-9).points.size(), 2u);
  EXPECT_TRUE(ThinSurface(ObjectModel(), 0.1).points.empty());
}

}  // namespace
}  // namespace rimod
