#include "rimod/hypothesis_ranking.h"

#include <gtest/gtest.h>

#include <cmath>

#include "rimod/scoring.h"
#include "tests/io/random_values.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

constexpr double kDepth = 2.0, kEpsilon = 0.1;

RankingParams Params() {
  RankingParams params;
  params.see_through = 1.0;
  params.outside = 1.0;
  params.first_points = 4;
  params.first_min_share = 0.25;
  return params;
}

SphericalGrid Grid() {
  SphericalGrid grid;
  grid.width = 60;
  grid.height = 40;
  grid.resolution = 0.01;
  grid.azimuth_left = 0.3;
  grid.elevation_top = 0.2;
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
  model.views[0].outside = outside;
  return model;
}

double Score(const RankingModel& model, const RankingParams& params = Params()) {
  return RankingScore(Wall(), model, Eigen::Isometry3f::Identity(), kEpsilon, params);
}

TEST(RankingScoreTest, PointsAtTheirPlaceCount) {
  EXPECT_NEAR(Score(ModelOf({PointAt(5, 5, kDepth), PointAt(5, 9, kDepth)})), 1.0, 0.01);
  EXPECT_NEAR(Score(ModelOf({PointAt(5, 5, kDepth), PointAt(5, 9, kDepth + 0.05)})), 0.75, 0.01);
}

TEST(RankingScoreTest, OccludedAndUnknownPointsNeitherHelpNorHarm) {
  const double score = Score(ModelOf({PointAt(5, 5, kDepth), PointAt(5, 9, kDepth + 1.0),
                                      PointAt(-5, 9, kDepth), PointAt(5, 70, kDepth)}));
  EXPECT_NEAR(score, 0.25, 0.01);
}

TEST(RankingScoreTest, LookedThroughPointsCost) {
  const RankingModel model = ModelOf({PointAt(5, 5, kDepth), PointAt(5, 6, kDepth),
                                      PointAt(5, 7, kDepth), PointAt(5, 9, kDepth - 0.5)});
  EXPECT_NEAR(Score(model), 0.5, 0.01);
  RankingParams params = Params();
  params.see_through = 3.0;
  EXPECT_NEAR(Score(model, params), 0.0, 0.01);
  // A beam without return went through, too.
  EXPECT_NEAR(Score(ModelOf({PointAt(5, 5, kDepth), PointAt(5, 6, kDepth), PointAt(5, 7, kDepth),
                             PointAt(0, 0, kDepth)})),
              0.5, 0.01);
}

TEST(RankingScoreTest, AnOutsideThatGoesOnCosts) {
  const std::vector<Eigen::Vector3f> points = {PointAt(5, 5, kDepth)};
  EXPECT_NEAR(Score(ModelOf(points, {PointAt(8, 8, kDepth - 0.5), PointAt(9, 9, kDepth)})), 0.5,
              0.01);
  EXPECT_NEAR(Score(ModelOf(points, {PointAt(8, 8, kDepth - 0.5), PointAt(0, 0, kDepth)})), 1.0,
              0.01);
}

TEST(RankingScoreTest, HopelessOnesAreGivenUp) {
  std::vector<Eigen::Vector3f> points(4, PointAt(5, 5, kDepth - 1.0));  // none at its place
  points.insert(points.end(), 50, PointAt(5, 5, kDepth));
  EXPECT_EQ(Score(ModelOf(points)), 0.0);
  RankingParams patient = Params();
  patient.first_min_share = 0.0;
  EXPECT_GT(Score(ModelOf(points), patient), 0.8);
}

TEST(RankingScoreTest, NothingToCompareIsZero) {
  EXPECT_EQ(Score(RankingModel{}), 0.0);
  EXPECT_EQ(Score(ModelOf({})), 0.0);
  const Scene empty(RangeImage(), 0.05, Execution{});
  EXPECT_EQ(RankingScore(empty, ModelOf({PointAt(5, 5, kDepth)}), Eigen::Isometry3f::Identity(),
                         kEpsilon, Params()),
            0.0);
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
    EXPECT_EQ(ranking.views[v].outside, model.views[v].outside_points);
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
