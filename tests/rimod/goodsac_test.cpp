#include "rimod/goodsac.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "tests/io/random_values.h"
#include "tests/support/matchers.h"
#include "tests/support/ray_caster.h"

namespace rimod {
namespace {

using Triple = std::array<int, 3>;

std::vector<Triple> AllTriples(int count) {
  std::vector<Triple> triples;
  VisitTriples(count, [&](int i, int j, int k) {
    triples.push_back({i, j, k});
    return true;
  });
  return triples;
}

// Rejects nothing but what cannot be computed.
GoodsacParams Lenient() {
  GoodsacParams params;
  params.max_correspondences = 100;
  params.max_trials = 100000;
  params.max_triples = 1000000;
  params.min_separation = 0.0;
  params.distance_tolerance = 10.0;
  params.min_triangle_height = 0.0;
  params.min_normal_cosine = -1.0;
  params.max_tilt = M_PI;
  params.min_model_spacing = 0.0;
  params.angle_tolerance = M_PI;
  params.height_tolerance = 1000.0;
  params.max_poses_a_correspondence = 0;
  return params;
}

// Model features and the same in a scene, moved by T_sensor_object; correspondence i joins the two
// features i and is worse than those before it.
struct Case {
  std::vector<Feature> scene, model;
  std::vector<Correspondence> correspondences;

  std::vector<const Feature*> ModelPointers() const {
    std::vector<const Feature*> pointers;
    for (const Feature& feature : model) pointers.push_back(&feature);
    return pointers;
  }
  std::vector<Eigen::Isometry3d> Poses(const GoodsacParams& params) const {
    return CandidatePoses(correspondences, scene, ModelPointers(), params);
  }
};

Case MakeCase(const std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& T) {
  Case made;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Feature model, scene;
    model.position = points[i].cast<float>();
    model.normal = Eigen::Vector3f::UnitX();
    scene.position = (T * points[i]).cast<float>();
    scene.normal = (T.linear() * Eigen::Vector3d::UnitX()).cast<float>();
    made.model.push_back(model);
    made.scene.push_back(scene);
    const int index = static_cast<int>(i);
    made.correspondences.push_back({index, index, 0.001 * (index + 1)});
  }
  return made;
}

Case Triangle(const Eigen::Isometry3d& T) {
  return MakeCase({{0, 0, 0}, {0.3, 0, 0}, {0, 0.4, 0}}, T);
}

Case RandomCase(int count, unsigned seed, const Eigen::Isometry3d& T) {
  RandomValues random(seed);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(random.Vector(0.5));
  return MakeCase(points, T);
}

TEST(VisitTriplesTest, ComesInThePapersOrder) {
  const std::vector<Triple> expected = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}, {0, 1, 4},
                                        {0, 2, 4}, {1, 2, 4}, {0, 3, 4}, {1, 3, 4}, {2, 3, 4}};
  EXPECT_EQ(AllTriples(5), expected);
}

TEST(VisitTriplesTest, VisitsEachTripleOnceAndBetterOnesFirst) {
  const int count = 23;
  const std::vector<Triple> triples = AllTriples(count);
  EXPECT_EQ(triples.size(), 23u * 22u * 21u / 6u);
  EXPECT_EQ(std::set<Triple>(triples.begin(), triples.end()).size(), triples.size());
  int worst = 0;
  for (const auto& [i, j, k] : triples) {
    EXPECT_TRUE(0 <= i && i < j && j < k && k < count);
    EXPECT_GE(k, worst);
    worst = k;
  }
}

TEST(VisitTriplesTest, FewerThanThreeHaveNone) {
  for (const int count : {-3, 0, 1, 2}) EXPECT_TRUE(AllTriples(count).empty());
  EXPECT_EQ(AllTriples(3).size(), 1u);
}

TEST(VisitTriplesTest, StopsWhenTold) {
  int visits = 0;
  VisitTriples(100, [&](int, int, int) { return ++visits < 7; });
  EXPECT_EQ(visits, 7);
}

TEST(CandidatePosesTest, ThreeTrueCorrespondencesGiveThePose) {
  RandomValues random(1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d T = random.Pose();
    const std::vector<Eigen::Isometry3d> poses = Triangle(T).Poses(Lenient());
    ASSERT_EQ(poses.size(), 1u);
    EXPECT_TRUE(PosesNear(poses[0], T, 1e-4, 1e-4));
  }
}

TEST(CandidatePosesTest, AllTriplesOfTrueCorrespondencesAgree) {
  const Eigen::Isometry3d T = RandomValues(2).Pose();
  const std::vector<Eigen::Isometry3d> poses = RandomCase(12, 3, T).Poses(Lenient());
  EXPECT_EQ(poses.size(), 12u * 11u * 10u / 6u);
}

TEST(CandidatePosesTest, PosesComeInTheOrderOfTheTriples) {
  // The fourth scene point is elsewhere: only the first triple gives the true pose.
  const Eigen::Isometry3d T = RandomValues(4).Pose();
  Case wrong = MakeCase({{0, 0, 0}, {0.3, 0, 0}, {0, 0.4, 0}, {0.3, 0.2, 0.1}}, T);
  wrong.scene[3].position += Eigen::Vector3f(0.1f, -0.2f, 0.15f);
  const std::vector<Eigen::Isometry3d> poses = wrong.Poses(Lenient());
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_TRUE(PosesNear(poses[0], T, 1e-4, 1e-4));
  for (std::size_t i = 1; i < poses.size(); ++i) EXPECT_FALSE(PosesNear(poses[i], T, 1e-4, 1e-4));
}

TEST(CandidatePosesTest, OrderOfTheInputDoesNotMatter) {
  Case given = RandomCase(10, 5, RandomValues(6).Pose());
  for (Correspondence& c : given.correspondences) c.distance = 0.01;  // all tied
  const std::vector<Eigen::Isometry3d> poses = given.Poses(Lenient());
  std::mt19937 generator(7);
  for (int i = 0; i < 5; ++i) {
    std::shuffle(given.correspondences.begin(), given.correspondences.end(), generator);
    const std::vector<Eigen::Isometry3d> again = given.Poses(Lenient());
    ASSERT_EQ(again.size(), poses.size());
    for (std::size_t k = 0; k < poses.size(); ++k) EXPECT_EQ(again[k].matrix(), poses[k].matrix());
  }
}

TEST(CandidatePosesTest, OnlyTheBestCorrespondencesAreUsed) {
  const Eigen::Isometry3d T = RandomValues(8).Pose();
  Case given = RandomCase(20, 9, T);
  for (std::size_t i = 5; i < 20; ++i) given.scene[i].position.x() += 3.0f;  // the worse are wrong
  std::reverse(given.correspondences.begin(), given.correspondences.end());
  GoodsacParams params = Lenient();
  params.max_correspondences = 5;
  const std::vector<Eigen::Isometry3d> poses = given.Poses(params);
  EXPECT_EQ(poses.size(), 10u);
  for (const Eigen::Isometry3d& pose : poses) EXPECT_TRUE(PosesNear(pose, T, 1e-3, 1e-3));
}

TEST(CandidatePosesTest, TrialsAndTriplesAreLimited) {
  const Case given = RandomCase(15, 10, Eigen::Isometry3d::Identity());
  const std::vector<Eigen::Isometry3d> all = given.Poses(Lenient());
  GoodsacParams params = Lenient();
  params.max_trials = 7;
  const std::vector<Eigen::Isometry3d> first = given.Poses(params);
  ASSERT_EQ(first.size(), 7u);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].matrix(), all[i].matrix());
  params = Lenient();
  params.max_triples = 9;
  EXPECT_LE(given.Poses(params).size(), 9u);
}

TEST(CandidatePosesTest, RejectsTriplesWhoseDistancesDiffer) {
  GoodsacParams params = Lenient();
  params.distance_tolerance = 0.05;
  Case given = Triangle(Eigen::Isometry3d::Identity());
  given.scene[1].position.x() += 0.04f;
  EXPECT_EQ(given.Poses(params).size(), 1u);
  given.scene[1].position.x() += 0.02f;
  EXPECT_TRUE(given.Poses(params).empty());
}

TEST(CandidatePosesTest, RejectsTriplesThatAreTooNear) {
  GoodsacParams params = Lenient();
  params.min_separation = 0.29;
  const Case given = Triangle(Eigen::Isometry3d::Identity());
  EXPECT_EQ(given.Poses(params).size(), 1u);
  params.min_separation = 0.31;
  EXPECT_TRUE(given.Poses(params).empty());
}

TEST(CandidatePosesTest, RejectsTriplesOnALine) {
  GoodsacParams params = Lenient();
  params.min_triangle_height = 0.05;
  const Eigen::Isometry3d T = RandomValues(11).Pose();
  EXPECT_EQ(MakeCase({{0, 0, 0}, {0.2, 0.06, 0}, {0.4, 0, 0}}, T).Poses(params).size(), 1u);
  EXPECT_TRUE(MakeCase({{0, 0, 0}, {0.2, 0.04, 0}, {0.4, 0, 0}}, T).Poses(params).empty());
  EXPECT_TRUE(MakeCase({{0, 0, 0}, {0.4, 0, 0}, {0.2, 0, 0}}, T).Poses(params).empty());
}

TEST(CandidatePosesTest, RejectsOneFeatureTakenTwice) {
  GoodsacParams params = Lenient();
  params.min_separation = 0.05;
  Case given = Triangle(Eigen::Isometry3d::Identity());
  given.correspondences[2].scene_feature = 1;
  EXPECT_TRUE(given.Poses(params).empty());
}

TEST(CandidatePosesTest, RejectsNormalsThatDoNotFit) {
  GoodsacParams params = Lenient();
  params.min_normal_cosine = 0.8;
  Case given = Triangle(RandomValues(12).Pose());
  EXPECT_EQ(given.Poses(params).size(), 1u);
  given.scene[2].normal = -given.scene[2].normal;
  EXPECT_TRUE(given.Poses(params).empty());
}

TEST(CandidatePosesTest, RejectsPosesThatTiltTooFar) {
  GoodsacParams params = Lenient();
  params.max_tilt = 0.3;
  for (const double tilt : {0.0, 0.29, 0.31, 1.0, M_PI}) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = (Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()))
                     .toRotationMatrix();
    EXPECT_EQ(Triangle(T).Poses(params).size(), tilt < 0.3 ? 1u : 0u) << tilt;
  }
}

TEST(CandidatePosesTest, RejectsPairsWhoseHeightsDiffer) {
  GoodsacParams params = Lenient();
  params.height_tolerance = 0.05;
  const Case upright = Triangle(Placed(1, 2, 3, 0.7));
  EXPECT_EQ(upright.Poses(params).size(), 1u);
  Eigen::Isometry3d lying = Placed(1, 2, 3, 0.7);
  lying.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(Triangle(lying).Poses(params).empty());
}

TEST(CandidatePosesTest, RejectsPairsWhoseNormalsStandOtherwise) {
  GoodsacParams params = Lenient();
  params.angle_tolerance = 0.2;
  Case given = Triangle(RandomValues(14).Pose());
  EXPECT_EQ(given.Poses(params).size(), 1u);
  const Eigen::Vector3f axis = given.scene[1].normal.unitOrthogonal();
  given.scene[1].normal = Eigen::AngleAxisf(0.4f, axis) * given.scene[1].normal;
  EXPECT_TRUE(given.Poses(params).empty());
}

TEST(CandidatePosesTest, ASceneFeaturesWorseMatchesAreLeftOutWhenTold) {
  // Each scene feature also matches, worse, the model's feature beside its own.
  Case given = RandomCase(6, 15, Eigen::Isometry3d::Identity());
  const std::size_t alone = given.Poses(Lenient()).size();
  for (int i = 0; i < 6; ++i) {
    Feature beside = given.model[i];
    beside.position.x() += 0.02f;
    given.model.push_back(beside);
    given.correspondences.push_back({i, 6 + i, 1.0});
  }
  EXPECT_GT(given.Poses(Lenient()).size(), alone);
  GoodsacParams params = Lenient();
  params.min_model_spacing = 0.03;
  EXPECT_EQ(given.Poses(params).size(), alone);
  params.min_model_spacing = 0.01;
  EXPECT_GT(given.Poses(params).size(), alone);
}

TEST(CandidatePosesTest, PosesOfEachCorrespondenceAreLimitedWhenTold) {
  GoodsacParams params = Lenient();
  params.max_poses_a_correspondence = 2;
  // Of 8 correspondences the third is the worst of one triple, the five after it of two or more.
  EXPECT_EQ(RandomCase(8, 16, Eigen::Isometry3d::Identity()).Poses(params).size(), 1u + 5u * 2u);
}

TEST(CandidatePosesTest, TooFewOrUnusableCorrespondencesGiveNothing) {
  GoodsacParams params = Lenient();
  params.min_separation = 0.01;
  EXPECT_TRUE(Case{}.Poses(params).empty());
  EXPECT_TRUE(RandomCase(2, 13, Eigen::Isometry3d::Identity()).Poses(params).empty());
  const std::vector<Eigen::Vector3d> same(10, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(MakeCase(same, Eigen::Isometry3d::Identity()).Poses(params).empty());
  Case nan = Triangle(Eigen::Isometry3d::Identity());
  nan.scene[1].position.setConstant(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(nan.Poses(params).empty());
}

std::vector<Eigen::Isometry3d> RandomPoses(const Case& of, const GoodsacParams& params,
                                           std::uint32_t seed) {
  return RandomCandidatePoses(of.correspondences, of.scene, of.ModelPointers(), params, seed);
}

TEST(RandomCandidatePosesTest, ComeFromTheSeedAlone) {
  const Case made = RandomCase(30, 11, RandomValues(12).Pose());
  GoodsacParams params = Lenient();
  params.max_trials = 50;
  const auto once = RandomPoses(made, params, 1), again = RandomPoses(made, params, 1);
  const auto other = RandomPoses(made, params, 2);
  ASSERT_EQ(once.size(), 50u);
  ASSERT_EQ(again.size(), 50u);
  bool differ = false;
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].matrix(), again[i].matrix());
    differ = differ || once[i].matrix() != other[i].matrix();
  }
  EXPECT_TRUE(differ);
}

// Four correspondences, of which one is false: one triple of four gives the pose. Each of the four
// is drawn as often as the others.
TEST(RandomCandidatePosesTest, DrawAllTriplesAlike) {
  const Eigen::Isometry3d T = RandomValues(13).Pose();
  Case made = MakeCase({{0, 0, 0}, {0.3, 0, 0}, {0, 0.4, 0}, {0, 0, 0.5}}, T);
  made.scene[3].position += Eigen::Vector3f(0.2f, 0.3f, 0.1f);
  GoodsacParams params = Lenient();
  params.max_trials = 4000;
  int correct = 0;
  for (const Eigen::Isometry3d& pose : RandomPoses(made, params, 3))
    correct += (pose.translation() - T.translation()).norm() < 1e-3;
  EXPECT_NEAR(correct, 1000, 120);  // four standard deviations
}

// Both try the same triples: with draws enough each pose of one is among the other's.
TEST(RandomCandidatePosesTest, AreThoseOfTheOrderedSearch) {
  const Case made = RandomCase(8, 14, RandomValues(15).Pose());
  GoodsacParams params = Lenient();
  params.min_separation = 0.3;
  params.min_triangle_height = 0.1;
  params.max_trials = 3000;
  const std::vector<Eigen::Isometry3d> ordered = made.Poses(params);
  ASSERT_GT(ordered.size(), 5u);
  ASSERT_LT(ordered.size(), 56u);
  const std::vector<Eigen::Isometry3d> random = RandomPoses(made, params, 4);
  const auto has = [](const std::vector<Eigen::Isometry3d>& poses, const Eigen::Isometry3d& pose) {
    return std::any_of(poses.begin(), poses.end(), [&](const Eigen::Isometry3d& other) {
      return other.matrix().isApprox(pose.matrix(), 1e-9);
    });
  };
  for (const Eigen::Isometry3d& pose : ordered) EXPECT_TRUE(has(random, pose));
  for (const Eigen::Isometry3d& pose : random) EXPECT_TRUE(has(ordered, pose));
}

TEST(RandomCandidatePosesTest, KeepToTheBudget) {
  const Case made = RandomCase(30, 16, Eigen::Isometry3d::Identity());
  GoodsacParams params = Lenient();
  params.max_triples = 7;
  EXPECT_LE(RandomPoses(made, params, 5).size(), 7u);
  params.max_triples = 1000000;
  params.max_trials = 9;
  EXPECT_EQ(RandomPoses(made, params, 5).size(), 9u);
}

TEST(RandomCandidatePosesTest, NoneOfFewerThanThree) {
  for (const int count : {0, 1, 2}) {
    GoodsacParams params = Lenient();
    params.max_triples = 1000;
    EXPECT_TRUE(
        RandomPoses(RandomCase(count, 17, Eigen::Isometry3d::Identity()), params, 6).empty());
  }
}

}  // namespace
}  // namespace rimod
