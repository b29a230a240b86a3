#include "rimod/false_positive_rejection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "rimod/surface_rendering.h"
#include "tests/io/random_values.h"
#include "tests/support/ray_caster.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

Candidate At(double x, double y, double score, int model = 0, double heading = 0.0) {
  return {model, Placed(x, y, 0.0, heading), score};
}

std::vector<double> Scores(const std::vector<Candidate>& candidates) {
  std::vector<double> scores;
  for (const Candidate& candidate : candidates) scores.push_back(candidate.score);
  return scores;
}

// --- order -----------------------------------------------------------------------------------

TEST(BetterCandidateTest, GivesOneOrderWhateverTheInput) {
  RandomValues random(1);
  std::vector<Candidate> candidates;
  for (int i = 0; i < 300; ++i)  // many ties in score, model and coordinates
    candidates.push_back(At(random.Int(0, 3), random.Int(0, 3), 0.1 * random.Int(0, 3),
                            random.Int(0, 2), 0.5 * random.Int(0, 4)));
  std::vector<Candidate> shuffled = candidates;
  std::mt19937 generator(2);
  std::shuffle(shuffled.begin(), shuffled.end(), generator);
  std::sort(candidates.begin(), candidates.end(), BetterCandidate);
  std::sort(shuffled.begin(), shuffled.end(), BetterCandidate);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    EXPECT_EQ(candidates[i].score, shuffled[i].score);
    EXPECT_EQ(candidates[i].model, shuffled[i].model);
    EXPECT_EQ(candidates[i].T_sensor_object.matrix(), shuffled[i].T_sensor_object.matrix());
    EXPECT_FALSE(BetterCandidate(candidates[i], candidates[i]));
    EXPECT_GE(candidates[std::max<std::size_t>(i, 1) - 1].score, candidates[i].score);
  }
}

// --- pruning ---------------------------------------------------------------------------------

std::vector<ObjectModel> TwoModels() {
  return {BoxModel("a", {0.6, 0.6, 0.6}, 0.05), BoxModel("b", {0.6, 0.6, 0.6}, 0.05)};
}

PruningParams Pruning(double radius) {
  PruningParams params;
  params.radius = radius;
  return params;
}

TEST(PruneToLocalBestTest, KeepsTheBestOfNearOnesAndAllThatAreFarApart) {
  const std::vector<ObjectModel> models = TwoModels();  // diameter 1.04 m
  const std::vector<Candidate> kept = PruneToLocalBest(
      {At(2.1, 0, 0.5), At(2, 0, 0.9), At(2, 0.1, 0.8), At(2, 3, 0.4)}, models, Pruning(0.3));
  EXPECT_EQ(Scores(kept), (std::vector<double>{0.9, 0.4}));
}

TEST(PruneToLocalBestTest, ModelsDoNotPruneEachOther) {
  EXPECT_EQ(
      PruneToLocalBest({At(2, 0, 0.9, 0), At(2, 0, 0.8, 1)}, TwoModels(), Pruning(0.5)).size(), 2u);
}

TEST(PruneToLocalBestTest, APrunedCandidatePrunesNobody) {
  // In a row, each near its neighbour only: the middle one goes, the last stays.
  const std::vector<Candidate> kept = PruneToLocalBest(
      {At(2, 0, 0.9), At(2, 0.25, 0.8), At(2, 0.5, 0.7)}, TwoModels(), Pruning(0.3));
  EXPECT_EQ(Scores(kept), (std::vector<double>{0.9, 0.7}));
}

TEST(PruneToLocalBestTest, NoTwoThatAreKeptAreNearAndEachThatIsNotHasABetterNear) {
  RandomValues random(3);
  std::vector<Candidate> candidates;
  for (int i = 0; i < 200; ++i)
    candidates.push_back(At(random.Between(0, 4), random.Between(0, 4), random.Between(0, 1), 0));
  const double radius = 0.4 * TwoModels()[0].Diameter();
  const std::vector<Candidate> kept = PruneToLocalBest(candidates, TwoModels(), Pruning(0.4));
  const auto near = [&](const Candidate& a, const Candidate& b) {
    return (a.T_sensor_object.translation() - b.T_sensor_object.translation()).norm() < radius;
  };
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(near(kept[i], kept[j]));
  for (const Candidate& candidate : candidates) {
    EXPECT_TRUE(std::any_of(kept.begin(), kept.end(), [&](const Candidate& k) {
      return k.score >= candidate.score &&
             (near(k, candidate) || k.T_sensor_object.isApprox(candidate.T_sensor_object));
    }));
  }
}

TEST(PruneToLocalBestTest, OrderOfTheInputDoesNotMatter) {
  std::vector<Candidate> candidates = {At(2, 0, 0.5), At(2.1, 0, 0.5), At(2, 0.2, 0.5)};
  const std::vector<Candidate> kept = PruneToLocalBest(candidates, TwoModels(), Pruning(0.3));
  ASSERT_EQ(kept.size(), 1u);
  std::reverse(candidates.begin(), candidates.end());
  const std::vector<Candidate> again = PruneToLocalBest(candidates, TwoModels(), Pruning(0.3));
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].T_sensor_object.matrix(), kept[0].T_sensor_object.matrix());
}

TEST(PruneToLocalBestTest, NothingStaysNothing) {
  EXPECT_TRUE(PruneToLocalBest({}, TwoModels(), Pruning(0.3)).empty());
  EXPECT_TRUE(PruneToLocalBest({}, {}, Pruning(0.3)).empty());
}

// --- collisions ------------------------------------------------------------------------------

CollisionParams Collisions() {
  CollisionParams params;
  params.cell = 0.05;
  params.max_share = 0.1;
  return params;
}

std::vector<CollisionShape> Shapes() {
  std::vector<CollisionShape> shapes;
  for (const ObjectModel& model :
       {BoxModel("a", {0.6, 0.6, 0.6}, 0.02), BoxModel("b", {0.3, 0.3, 0.3}, 0.02)})
    shapes.emplace_back(model, Collisions().cell);
  return shapes;
}

TEST(CollisionShapeTest, IsALowResolutionCloudOfTheModel) {
  const ObjectModel model = BoxModel("a", {0.6, 0.4, 0.5}, 0.01);
  const CollisionShape shape(model, 0.05);
  EXPECT_LT(shape.points().size(), model.points.size() / 5);
  for (const Eigen::Vector3d& p : shape.points())
    EXPECT_LE((p - shape.centre()).norm(), shape.radius());
  EXPECT_TRUE(shape.centre().isApprox(Eigen::Vector3d(0, 0, 0.25)));
  for (const Eigen::Vector3f& p : model.points)
    EXPECT_TRUE(shape.HasPointWithin(p.cast<double>(), 0.06));
  EXPECT_FALSE(shape.HasPointWithin(shape.centre(), 0.15));
  EXPECT_FALSE(shape.HasPointWithin({2, 0, 0}, 0.5));
}

TEST(RejectCollisionsTest, TheBetterOfTwoInOnePlaceStays) {
  const std::vector<Candidate> kept =
      RejectCollisions({At(2, 0, 0.9, 0), At(2.05, 0.02, 0.8, 0, 0.1)}, Shapes(), Collisions());
  EXPECT_EQ(Scores(kept), std::vector<double>{0.9});
}

TEST(RejectCollisionsTest, NeighboursThatDoNotTouchStay) {
  const std::vector<Candidate> candidates = {At(2, 0, 0.9, 0), At(2, 0.75, 0.8, 0),
                                             At(2, -0.55, 0.7, 1)};
  EXPECT_EQ(RejectCollisions(candidates, Shapes(), Collisions()).size(), 3u);
}

TEST(RejectCollisionsTest, DifferentModelsCollideToo) {
  // The small box stands in the large one's corner, faces on faces.
  for (const bool small_first : {false, true}) {
    std::vector<Candidate> candidates = {At(2, 0, 0.9, 0), At(2.15, 0.15, 0.8, 1)};
    if (small_first) std::swap(candidates[0].score, candidates[1].score);
    std::sort(candidates.begin(), candidates.end(), BetterCandidate);
    const std::vector<Candidate> kept = RejectCollisions(candidates, Shapes(), Collisions());
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_EQ(kept[0].model, small_first ? 1 : 0);
  }
}

TEST(RejectCollisionsTest, ARejectedCandidateRejectsNobody) {
  const std::vector<Candidate> kept = RejectCollisions(
      {At(2, 0, 0.9, 0), At(2, 0.4, 0.8, 0), At(2, 0.75, 0.7, 0)}, Shapes(), Collisions());
  EXPECT_EQ(Scores(kept), (std::vector<double>{0.9, 0.7}));
}

TEST(RejectCollisionsTest, AllOrNothingShares) {
  CollisionParams all = Collisions();
  all.max_share = 1.0;
  EXPECT_EQ(RejectCollisions({At(2, 0, 0.9), At(2, 0, 0.8)}, Shapes(), all).size(), 2u);
  EXPECT_TRUE(RejectCollisions({}, Shapes(), Collisions()).empty());
  EXPECT_TRUE(RejectCollisions({}, {}, Collisions()).empty());
}

TEST(RejectCollisionsTest, AModelWithoutPointsCollidesWithNothing) {
  std::vector<CollisionShape> shapes;
  shapes.emplace_back(ObjectModel{}, 0.05);
  EXPECT_EQ(RejectCollisions({At(2, 0, 0.9), At(2, 0, 0.8)}, shapes, Collisions()).size(), 2u);
}

// --- validation by rendering -----------------------------------------------------------------

ValidationParams Validation() {
  ValidationParams params;
  params.scoring.epsilon = 0.05;
  params.scoring.penalty = 10.0;
  params.scoring.no_return_penalty = 0.5;
  params.scoring.window = 0;
  params.min_pixels = 20;
  params.half_trust_pixels = 0;
  params.outside_weight = 0.0;
  params.outside_gap = 2;
  params.outside_depth = 0.1;
  params.ground_height = 0.05;
  return params;
}

const ObjectModel& Crate() {
  static const ObjectModel crate = BoxModel("crate", {0.5, 0.4, 0.6}, 0.01);
  return crate;
}

const Eigen::Isometry3d kCratePose = Placed(2.5, 0.1, -0.8, 0.5);

// A crate (or none) before a wall, and whatever else.
RangeImage SeeCrate(bool with_crate, const std::vector<BoxShape>& others = {}) {
  World world;
  world.planes = {{Eigen::Vector3d(4, 0, 0), -Eigen::Vector3d::UnitX()}};
  if (with_crate) {
    BoxShape box;
    box.T_local_box = kCratePose * Eigen::Translation3d(0, 0, 0.3);
    box.half_size = Eigen::Vector3d(0.25, 0.2, 0.3);
    world.boxes.push_back(box);
  }
  world.boxes.insert(world.boxes.end(), others.begin(), others.end());
  BeamPattern pattern;
  pattern.step = 0.0034;
  RangeImageParams params;
  params.resolution = 0.007;
  return MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), pattern), params);
}

TEST(ValidatePoseTest, TheTruePoseScoresWell) {
  ValidationParams params = Validation();
  params.scoring.window = 1;  // pixels of the rim see the wall
  EXPECT_GT(ValidatePose(SeeCrate(true), Crate(), kCratePose, params), 0.85);
}

TEST(ValidatePoseTest, FallsWithTheDistanceFromTheTruePose) {
  const RangeImage image = SeeCrate(true);
  ValidationParams params = Validation();
  params.scoring.penalty = 0.0;
  params.scoring.window = 1;
  double before = ValidatePose(image, Crate(), kCratePose, params);
  for (const double away : {0.02, 0.04, 0.08}) {
    Eigen::Isometry3d pose = kCratePose;
    pose.pretranslate(Eigen::Vector3d(-away, 0, 0));
    const double score = ValidatePose(image, Crate(), pose, params);
    EXPECT_LT(score, before);
    before = score;
  }
  EXPECT_LT(before, 0.1);
}

TEST(ValidatePoseTest, WhatTheLaserLooksThroughIsRejected) {
  EXPECT_EQ(ValidatePose(SeeCrate(false), Crate(), kCratePose, Validation()), 0.0);
}

TEST(ValidatePoseTest, WhatIsHiddenIsNoEvidence) {
  BoxShape screen;
  screen.T_local_box = Placed(1.2, 0, 0, 0);
  screen.half_size = Eigen::Vector3d(0.05, 1.0, 1.0);
  EXPECT_EQ(ValidatePose(SeeCrate(true, {screen}), Crate(), kCratePose, Validation()), 0.0);
}

TEST(ValidatePoseTest, TooFewPixelsSayNothing) {
  const RangeImage image = SeeCrate(true);
  ValidationParams params = Validation();
  params.scoring.window = 1;
  ASSERT_GT(ValidatePose(image, Crate(), kCratePose, params), 0.5);
  params.min_pixels = 100000;
  EXPECT_EQ(ValidatePose(image, Crate(), kCratePose, params), 0.0);
  EXPECT_EQ(ValidatePose(image, Crate(), Placed(-3, 0, 0, 0), Validation()), 0.0);  // behind
  EXPECT_EQ(ValidatePose(RangeImage(), Crate(), kCratePose, Validation()), 0.0);
}

TEST(ValidatePoseTest, FewPixelsAreTrustedLessWhenTold) {
  const RangeImage image = SeeCrate(true);
  ValidationParams params = Validation();
  params.scoring.window = 1;
  const double score = ValidatePose(image, Crate(), kCratePose, params);
  const int pixels = RenderModel(Crate(), kCratePose, image.grid()).CountSeen();
  params.half_trust_pixels = pixels;
  EXPECT_NEAR(ValidatePose(image, Crate(), kCratePose, params), 0.5 * score, 1e-9);
}

TEST(LookAroundTest, AnObjectStandsFreeAndAPatchOfWallDoesNot) {
  const RangeImage image = SeeCrate(true);
  const SilhouetteSurroundings crate =
      LookAround(image, RenderModel(Crate(), kCratePose, image.grid()), kCratePose, Validation());
  EXPECT_GT(crate.compared, 50);
  EXPECT_LT(crate.continued, crate.compared / 20);

  const ObjectModel plate = PlateModel("plate", 0.6, 0.01);
  const Eigen::Isometry3d in_wall = Placed(4.0, -0.8, -0.4, M_PI);  // its front is the wall's
  const SilhouetteSurroundings wall =
      LookAround(image, RenderModel(plate, in_wall, image.grid()), in_wall, Validation());
  EXPECT_GT(wall.compared, 50);
  EXPECT_GT(wall.continued, wall.compared * 9 / 10);
}

TEST(ValidatePoseTest, ASceneThatGoesOnCostsItsWeight) {
  const RangeImage image = SeeCrate(false);
  const ObjectModel plate = PlateModel("plate", 0.6, 0.01);
  const Eigen::Isometry3d in_wall = Placed(4.0, -0.8, -0.4, M_PI);
  ValidationParams params = Validation();
  params.scoring.window = 1;
  EXPECT_GT(ValidatePose(image, plate, in_wall, params), 0.9);
  params.outside_weight = 1.0;
  EXPECT_LT(ValidatePose(image, plate, in_wall, params), 0.1);
}

}  // namespace
}  // namespace rimod
