#include "rimod/hypothesis_ranking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "rimod/scoring.h"
#include "tests/io/random_values.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

constexpr double kDepth = 2.0, kEpsilon = 0.1;

RankingParams Params() {
  RankingParams params;
  params.first_points = 4;
  params.min_known = 0.0;
  params.first_min_share = 0.25;
  params.second_min_share = 0.25;
  return params;
}

PixelGrid Grid() {
  PixelGrid grid;
  grid.width = 60;
  grid.height = 40;
  grid.resolution = 0.01;
  grid.left = 0.3;
  grid.top = 0.2;
  return grid;
}

// Measured at kDepth everywhere, but without return right of the middle's right half.
Scene Wall() {
  RangeImage image(Grid(), Eigen::Isometry3d::Identity());
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column)
      image.SetMeasured(row, column, {1600, 0, 0});
  image.SetNoReturn(0, 0);
  return Scene(image, 0.05, Execution{});
}

Eigen::Vector3f PointAt(int row, int column, double range) {
  const Eigen::Vector3d p = range * UnitVector(PixelDirection(Grid(), row + 0.5, column + 0.5));
  return p.cast<float>();
}

RankingModel ModelOf(const std::vector<Eigen::Vector3f>& points,
                     const std::vector<Eigen::Vector3f>& outside = {}) {
  RankingModel model;
  model.centre = Eigen::Vector3f(2, 0, 0);
  model.views.resize(1);
  model.views[0].direction = -Eigen::Vector3f::UnitX();
  model.views[0].surface.points = points;
  model.views[0].surface.normals.assign(points.size(), -Eigen::Vector3f::UnitX());
  model.views[0].points = PointColumns(points);
  model.views[0].outside = PointColumns(outside);
  return model;
}

bool Compare(const Scene& scene, const RankingModel& model, const RankingParams& params,
             RankingFigures* figures) {
  return ViewComparison(scene, kEpsilon, params)
      .Compare(model, Eigen::Isometry3f::Identity(), figures);
}

// What is found at the pose where the model's points lie; nothing for a hopeless one.
std::optional<RankingFigures> Compare(const RankingModel& model,
                                      const RankingParams& params = Params()) {
  RankingFigures figures;
  if (!Compare(Wall(), model, params, &figures)) return std::nullopt;
  return figures;
}

TEST(ViewComparisonTest, PointsAtTheirPlaceCount) {
  EXPECT_NEAR(Compare(ModelOf({PointAt(5, 5, kDepth), PointAt(5, 9, kDepth)}))->at_place, 1.0,
              0.01);
  const RankingFigures half =
      *Compare(ModelOf({PointAt(5, 5, kDepth), PointAt(5, 9, kDepth + 0.05)}));
  EXPECT_NEAR(half.at_place, 0.75, 0.01);
  EXPECT_NEAR(half.hits, 1.0, 1e-6);
  EXPECT_NEAR(half.agreeing, 1.0, 0.05);  // the wall's normals
}

TEST(ViewComparisonTest, OccludedAndUnknownPointsAreNotKnown) {
  const RankingFigures figures =
      *Compare(ModelOf({PointAt(5, 5, kDepth), PointAt(5, 9, kDepth + 1.0), PointAt(-5, 9, kDepth),
                        PointAt(5, 70, kDepth)}));
  EXPECT_NEAR(figures.known, 0.25, 1e-6);
  EXPECT_NEAR(figures.at_place, 0.25, 0.01);
  EXPECT_EQ(figures.looked_through, 0.0f);
}

TEST(ViewComparisonTest, LookedThroughPointsAreCounted) {
  // A beam without return went through, too.
  const RankingFigures figures =
      *Compare(ModelOf({PointAt(5, 5, kDepth), PointAt(5, 6, kDepth), PointAt(5, 9, kDepth - 0.5),
                        PointAt(0, 0, kDepth)}));
  EXPECT_NEAR(figures.looked_through, 0.5, 1e-6);
  EXPECT_NEAR(figures.known, 1.0, 1e-6);
}

TEST(ViewComparisonTest, TheOutsideGoesOnOrJumps) {
  const std::vector<Eigen::Vector3f> points = {PointAt(5, 5, kDepth)};
  const RankingFigures figures =
      *Compare(ModelOf(points, {PointAt(8, 8, kDepth - 0.5), PointAt(9, 9, kDepth),
                                PointAt(0, 0, kDepth), PointAt(9, 9, kDepth + 1.0)}));
  EXPECT_NEAR(figures.jumps, 0.5, 1e-6);
  EXPECT_NEAR(figures.goes_on, 0.25, 1e-6);
}

TEST(ViewComparisonTest, HopelessOnesAreGivenUp) {
  std::vector<Eigen::Vector3f> points(4, PointAt(5, 5, kDepth - 1.0));  // none at its place
  points.insert(points.end(), 50, PointAt(5, 5, kDepth));
  EXPECT_FALSE(Compare(ModelOf(points)));
  RankingParams patient = Params();
  patient.first_min_share = 0.0;
  EXPECT_GT(Compare(ModelOf(points), patient)->at_place, 0.8);
  // The second look: 44 of the first 48 points are at their place.
  patient.second_min_share = 0.95;
  EXPECT_FALSE(Compare(ModelOf(points), patient));
  patient.second_points = 54;
  patient.second_min_share = 0.9;
  EXPECT_TRUE(Compare(ModelOf(points), patient));
  // Nearly all hidden: one point is no reason to go on.
  std::vector<Eigen::Vector3f> hidden(3, PointAt(5, 5, kDepth + 1.0));
  hidden.push_back(PointAt(5, 5, kDepth));
  EXPECT_TRUE(Compare(ModelOf(hidden)));
  RankingParams strict = Params();
  strict.min_known = 0.5;
  EXPECT_FALSE(Compare(ModelOf(hidden), strict));
}

TEST(ViewComparisonTest, WhatIsNotOfTheViewStays) {
  RankingFigures figures;
  figures.votes = 7.0f;
  figures.tilt = 0.3f;
  figures.at_place = 100.0f;
  ASSERT_TRUE(Compare(Wall(), ModelOf({PointAt(5, 5, kDepth)}), Params(), &figures));
  EXPECT_EQ(figures.votes, 7.0f);
  EXPECT_EQ(figures.tilt, 0.3f);
  EXPECT_NEAR(figures.at_place, 1.0, 0.01);
}

TEST(ViewComparisonTest, OnePoseSaysNothingOfTheNext) {
  const Scene wall = Wall();
  const RankingParams params = Params();
  ViewComparison comparison(wall, kEpsilon, params);
  const auto compare = [&](const RankingModel& model, ViewComparison* with) {
    RankingFigures figures;
    EXPECT_TRUE(with->Compare(model, Eigen::Isometry3f::Identity(), &figures));
    return figures;
  };
  const RankingModel large = ModelOf(std::vector<Eigen::Vector3f>(70, PointAt(5, 5, kDepth)),
                                     {PointAt(8, 8, kDepth), PointAt(8, 8, kDepth)});
  const RankingModel small =
      ModelOf({PointAt(5, 5, kDepth), PointAt(5, 9, kDepth + 0.05), PointAt(6, 9, kDepth)});
  compare(large, &comparison);
  const RankingFigures after = compare(small, &comparison);
  ViewComparison fresh(wall, kEpsilon, params);
  const RankingFigures alone = compare(small, &fresh);
  EXPECT_EQ(after.at_place, alone.at_place);
  EXPECT_EQ(after.hits, alone.hits);
  EXPECT_EQ(after.agreeing, alone.agreeing);
  EXPECT_EQ(after.goes_on, 0.0f);
  EXPECT_NEAR(alone.hits, 1.0, 1e-6);
}

TEST(ViewComparisonTest, NothingToCompareIsHopeless) {
  EXPECT_FALSE(Compare(RankingModel{}));
  EXPECT_FALSE(Compare(ModelOf({})));
  const Scene empty(RangeImage(), 0.05, Execution{});
  RankingFigures figures;
  EXPECT_TRUE(Compare(empty, ModelOf({PointAt(5, 5, kDepth)}), Params(), &figures));
  EXPECT_EQ(figures.known, 0.0f);
}

TEST(RankingModelTest, HoldsTheViewsPointsAndFindsTheNearestLikeScoring) {
  ObjectModel model = BoxModel("crate", {0.5, 0.4, 0.6}, 0.05);
  RandomValues random(1);
  const Eigen::Vector3d centre(0, 0, 0.3);
  for (int i = 0; i < 30; ++i) {
    ModelView view;
    view.viewpoint = centre + 2.5 * random.Unit();
    view.validation_points = {random.Vector(1.0).cast<float>()};
    view.validation_normals = {random.Unit().cast<float>()};
    view.outside_points = {random.Vector(1.0).cast<float>()};
    model.views.push_back(view);
  }
  const RankingModel ranking = MakeRankingModel(model);
  ASSERT_EQ(ranking.views.size(), 30u);
  for (int v = 0; v < 30; ++v) {
    EXPECT_EQ(ranking.views[v].surface.points, model.views[v].validation_points);
    EXPECT_EQ(ranking.views[v].surface.normals, model.views[v].validation_normals);
    EXPECT_EQ(ranking.views[v].points.At(0), model.views[v].validation_points[0]);
    EXPECT_EQ(ranking.views[v].outside.At(0), model.views[v].outside_points[0]);
  }
  int equal = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Isometry3d T = random.Pose();
    equal += NearestView(ranking, T.cast<float>()) == NearestView(model, T);
  }
  EXPECT_GE(equal, 298);  // but for ties that float decides otherwise
  EXPECT_EQ(NearestView(RankingModel{}, Eigen::Isometry3f::Identity()), -1);
}

}  // namespace
}  // namespace rimod
