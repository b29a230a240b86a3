#include "rimod/scoring.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/io/random_values.h"
#include "tests/support/matchers.h"

namespace rimod {
namespace {

constexpr double kDepth = 2.0;  // m, where the scene is measured in the images below

ScoringParams Params() {
  ScoringParams params;
  params.epsilon = 0.1;
  params.penalty = 10.0;
  params.no_return_penalty = 0.5;
  params.window = 0;
  params.gamma = 0.0;
  return params;
}

PixelGrid Grid() {
  PixelGrid grid;
  grid.width = 20;
  grid.height = 10;
  grid.resolution = 0.01;
  grid.left = 0.1;
  grid.top = 0.05;
  return grid;
}

RoundedPixel At(double range) {
  return {static_cast<std::uint16_t>(std::lround(range / PixelRounding::kRangeUnit)), 0, 0};
}

// Measured at kDepth everywhere.
RangeImage Wall() {
  RangeImage image(Grid(), Eigen::Isometry3d::Identity());
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column)
      image.SetMeasured(row, column, At(kDepth));
  return image;
}

Eigen::Vector3d PointAt(int row, int column, double range) {
  return range * UnitVector(PixelDirection(Grid(), row + 0.5, column + 0.5));
}

// A model with one view from in front whose validation points are these, in the sensor frame of a
// sensor at the object's origin.
ObjectModel ModelOf(const std::vector<Eigen::Vector3d>& points) {
  ObjectModel model;
  model.box_min = Eigen::Vector3d(1.9, -0.2, -0.2);
  model.box_max = Eigen::Vector3d(2.1, 0.2, 0.2);
  model.views.resize(1);
  for (const Eigen::Vector3d& p : points)
    model.views[0].validation_points.push_back(p.cast<float>());
  return model;
}

TEST(PointScoreTest, EqualDepthsAreOne) { EXPECT_EQ(PointScore(2.0, 2.0, Params()), 1.0); }

TEST(PointScoreTest, FallsWithTheDifferenceWithinEpsilon) {
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_NEAR(PointScore(2.0, 2.0 + sign * 0.05, Params()), 0.5, 1e-12);
    EXPECT_NEAR(PointScore(2.0, 2.0 + sign * 0.099, Params()), 0.01, 1e-12);
  }
}

TEST(PointScoreTest, LaserWentThroughCostsThePenalty) {
  // The scene is measured behind the model's point.
  EXPECT_EQ(PointScore(2.0, 2.11, Params()), -10.0);
  EXPECT_EQ(PointScore(2.0, 80.0, Params()), -10.0);
}

TEST(PointScoreTest, OccludedPointsSayNothing) {
  // The scene is measured in front of the model's point.
  EXPECT_EQ(PointScore(2.11, 2.0, Params()), 0.0);
  EXPECT_EQ(PointScore(80.0, 2.0, Params()), 0.0);
}

TEST(PointScoreTest, StaysWithinItsBounds) {
  RandomValues random(1);
  for (int i = 0; i < 1000; ++i) {
    const double score = PointScore(random.Between(0, 10), random.Between(0, 10), Params());
    EXPECT_TRUE(score == -10.0 || (score >= 0.0 && score <= 1.0)) << score;
  }
}

TEST(PointScoreInImageTest, TellsTheKindsOfPixelsApart) {
  RangeImage image(Grid(), Eigen::Isometry3d::Identity());
  image.SetMeasured(5, 5, At(kDepth));
  image.SetNoReturn(5, 7);
  EXPECT_NEAR(PointScoreInImage(image, PointAt(5, 5, kDepth), Params()), 1.0, 1e-3);
  EXPECT_EQ(PointScoreInImage(image, PointAt(5, 5, 1.5), Params()), -10.0);
  EXPECT_EQ(PointScoreInImage(image, PointAt(5, 5, 2.5), Params()), 0.0);
  EXPECT_EQ(PointScoreInImage(image, PointAt(5, 7, kDepth), Params()), -0.5);  // no return
  EXPECT_EQ(PointScoreInImage(image, PointAt(5, 9, kDepth), Params()), 0.0);   // never observed
  EXPECT_EQ(PointScoreInImage(image, PointAt(-1, 5, kDepth), Params()), 0.0);  // outside
  EXPECT_EQ(PointScoreInImage(image, PointAt(5, 20, kDepth), Params()), 0.0);
  EXPECT_EQ(PointScoreInImage(image, {-2.0, 0.0, 0.0}, Params()), 0.0);  // behind
}

TEST(PointScoreInImageTest, TheBestPixelOfTheWindowCounts) {
  RangeImage image(Grid(), Eigen::Isometry3d::Identity());
  image.SetMeasured(5, 5, At(4.0));
  image.SetNoReturn(5, 6);
  ScoringParams params = Params();
  const Eigen::Vector3d p = PointAt(5, 5, kDepth);
  EXPECT_EQ(PointScoreInImage(image, p, params), -10.0);
  params.window = 1;
  EXPECT_EQ(PointScoreInImage(image, p, params), -0.5);
  image.SetMeasured(4, 4, At(kDepth));
  EXPECT_NEAR(PointScoreInImage(image, p, params), 1.0, 1e-3);
  image.SetMeasured(4, 4, At(4.0));
  image.SetMeasured(3, 5, At(kDepth));  // two rows away
  EXPECT_EQ(PointScoreInImage(image, p, params), -0.5);
  params.window = 2;
  EXPECT_NEAR(PointScoreInImage(image, p, params), 1.0, 1e-3);
}

TEST(PointScoreInImageTest, AWindowOverTheEdgeUsesWhatIsInside) {
  ScoringParams params = Params();
  params.window = 1;
  const RangeImage wall = Wall();
  EXPECT_NEAR(PointScoreInImage(wall, PointAt(-1, 3, kDepth), params), 1.0, 1e-3);
  EXPECT_EQ(PointScoreInImage(wall, PointAt(-2, 3, kDepth), params), 0.0);
}

TEST(NearestViewTest, IsTheOneInWhoseDirectionTheSensorStands) {
  RandomValues random(2);
  ObjectModel model = ModelOf({});
  model.views.resize(40);
  const Eigen::Vector3d centre = 0.5 * (model.box_min + model.box_max);
  for (ModelView& view : model.views)
    view.viewpoint = centre + random.Between(1.0, 5.0) * random.Unit();
  for (int i = 0; i < 200; ++i) {
    const Eigen::Isometry3d T_sensor_object = random.Pose();
    const Eigen::Vector3d to_sensor = T_sensor_object.inverse().translation() - centre;
    int expected = -1;
    double smallest = 10.0;
    for (int v = 0; v < 40; ++v) {
      const Eigen::Vector3d to_view = model.views[v].viewpoint - centre;
      const double angle = std::acos(to_view.normalized().dot(to_sensor.normalized()));
      if (angle < smallest) smallest = angle, expected = v;
    }
    EXPECT_EQ(NearestView(model, T_sensor_object), expected);
  }
}

TEST(NearestViewTest, AModelWithoutViewsHasNone) {
  EXPECT_EQ(NearestView(ObjectModel{}, Eigen::Isometry3d::Identity()), -1);
}

TEST(ScorePoseTest, APerfectFitIsOne) {
  const ObjectModel model = ModelOf({PointAt(2, 3, kDepth), PointAt(5, 10, kDepth)});
  EXPECT_NEAR(ScorePose(Wall(), model, Eigen::Isometry3d::Identity(), Params()), 1.0, 1e-3);
}

TEST(ScorePoseTest, IsTheMeanOverAllPoints) {
  // One fits, one is half off, one is occluded, one is outside: (1 + 0.5 + 0 + 0) / 4.
  const ObjectModel model = ModelOf({PointAt(2, 3, kDepth), PointAt(3, 3, kDepth + 0.05),
                                     PointAt(4, 3, kDepth + 1.0), PointAt(40, 3, kDepth)});
  EXPECT_NEAR(ScorePose(Wall(), model, Eigen::Isometry3d::Identity(), Params()), 0.375, 1e-3);
}

TEST(ScorePoseTest, OnePointThatTheLaserWentThroughOutweighsTenThatFit) {
  std::vector<Eigen::Vector3d> points(10, PointAt(2, 3, kDepth));
  points.push_back(PointAt(2, 5, 1.0));
  EXPECT_NEAR(ScorePose(Wall(), ModelOf(points), Eigen::Isometry3d::Identity(), Params()), 0.0,
              2e-3);
  ScoringParams mild = Params();
  mild.penalty = 1.0;
  EXPECT_NEAR(ScorePose(Wall(), ModelOf(points), Eigen::Isometry3d::Identity(), mild), 9.0 / 11.0,
              2e-3);
}

TEST(ScorePoseTest, IsNeverNegative) {
  const ObjectModel model = ModelOf({PointAt(2, 3, 1.0), PointAt(2, 4, 1.0)});
  EXPECT_EQ(ScorePose(Wall(), model, Eigen::Isometry3d::Identity(), Params()), 0.0);
}

TEST(ScorePoseTest, FollowsThePose) {
  // The model in a frame of its own: its points reach the wall only at the right pose.
  const Eigen::Isometry3d T_sensor_object = RandomValues(3).Pose();
  ObjectModel model = ModelOf({});
  for (int column = 2; column < 18; ++column) {
    model.views[0].validation_points.push_back(
        (T_sensor_object.inverse() * PointAt(5, column, kDepth)).cast<float>());
  }
  EXPECT_NEAR(ScorePose(Wall(), model, T_sensor_object, Params()), 1.0, 2e-3);
  Eigen::Isometry3d nearer = T_sensor_object;
  nearer.pretranslate(Eigen::Vector3d(-0.05, 0, 0));
  EXPECT_NEAR(ScorePose(Wall(), model, nearer, Params()), 0.5, 0.05);
}

TEST(ScorePoseTest, NothingToCompareIsZero) {
  const Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  EXPECT_EQ(ScorePose(Wall(), ObjectModel{}, T, Params()), 0.0);
  EXPECT_EQ(ScorePose(Wall(), ModelOf({}), T, Params()), 0.0);
  EXPECT_EQ(ScorePose(RangeImage(), ModelOf({PointAt(2, 3, 2.0)}), T, Params()), 0.0);
}

TEST(ScorePoseTest, UsesTheNearestViewsPointsOnly) {
  ObjectModel model = ModelOf({PointAt(2, 3, kDepth)});
  model.views[0].viewpoint = Eigen::Vector3d(0, 0, 0);  // where the sensor is
  model.views.resize(2);
  model.views[1].viewpoint = Eigen::Vector3d(4, 0, 0);  // behind the object
  model.views[1].validation_points.assign(50, PointAt(2, 3, 1.0).cast<float>());
  EXPECT_NEAR(ScorePose(Wall(), model, Eigen::Isometry3d::Identity(), Params()), 1.0, 1e-3);
}

TEST(ScorePoseTest, ScoresBelowGammaMayBeGivenUp) {
  // Two of three fit: 0.667.
  const ObjectModel model =
      ModelOf({PointAt(2, 3, kDepth), PointAt(2, 5, kDepth), PointAt(2, 6, kDepth + 1.0)});
  ScoringParams params = Params();
  params.gamma = 0.6;
  EXPECT_NEAR(ScorePose(Wall(), model, Eigen::Isometry3d::Identity(), params), 0.667, 2e-3);
  params.gamma = 0.7;
  EXPECT_EQ(ScorePose(Wall(), model, Eigen::Isometry3d::Identity(), params), 0.0);
}

}  // namespace
}  // namespace rimod
