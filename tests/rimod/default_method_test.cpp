#include "rimod/default_method.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "rimod/feature_extraction.h"
#include "rimod/model_building.h"
#include "tests/support/executions.h"
#include "tests/support/furniture.h"
#include "tests/support/matchers.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

PipelineParams Params() {
  PipelineParams params = DefaultParams(Method::kDefault);
  params.range_image.resolution = 0.01;
  params.model_views.azimuths = 8;
  params.model_views.elevations = 1;
  params.matching.max_matches = 20;
  params.ranking.refined = {10, 200, 0.001};
  params.ranking.judged = {10, 60, 0.001};
  return params;
}

// --- choosing ----------------------------------------------------------------------------------

ChoiceParams Choice() {
  ChoiceParams choice;
  choice.min_probability = 0.5;
  choice.max_explained_share = 0.4;
  choice.same_class_distance = 0.4;
  choice.other_class_distance = 0.2;
  return choice;
}

class ChooseCandidatesTest : public testing::Test {
 protected:
  ChooseCandidatesTest()
      : image_(Grid(), Eigen::Isometry3d::Identity()),
        scene_(image_, 0.1, Execution{}),
        database_({BoxModel("a", {0.6, 0.6, 0.6}, 0.05), BoxModel("b", {0.6, 0.6, 0.6}, 0.05)},
                  Params(), Execution{}) {}

  static PixelGrid Grid() {
    PixelGrid grid;
    grid.width = 100;
    grid.height = 10;
    grid.resolution = 0.01;
    return grid;
  }

  // Far from all others unless x says otherwise; explains the pixels [first, last).
  static JudgedCandidate Judged(double score, int first, int last, double x, int model = 0) {
    JudgedCandidate judged;
    judged.candidate = {model, Placed(x, 0.0, 0.0, 0.0), score};
    judged.evidence.explained.resize(last - first);
    std::iota(judged.evidence.explained.begin(), judged.evidence.explained.end(), first);
    return judged;
  }

  std::vector<double> ChosenScores(const std::vector<JudgedCandidate>& judged) const {
    PipelineParams params = Params();
    params.choice = Choice();
    std::vector<double> scores;
    for (const Candidate& candidate :
         ChooseCandidates(scene_, judged, database_, params, Execution{}))
      scores.push_back(candidate.score);
    return scores;
  }

  RangeImage image_;
  Scene scene_;
  ModelDatabase database_;
};

using Scores = std::vector<double>;

TEST_F(ChooseCandidatesTest, ImprobableOnesAreLeftOut) {
  EXPECT_EQ(
      ChosenScores({Judged(0.9, 0, 100, 2), Judged(0.51, 100, 200, 4), Judged(0.49, 200, 300, 6)}),
      (Scores{0.9, 0.51}));
  EXPECT_TRUE(ChosenScores({}).empty());
}

TEST_F(ChooseCandidatesTest, EachPixelIsExplainedOnce) {
  // The second shares half of its pixels with the first, the third a quarter.
  EXPECT_EQ(
      ChosenScores({Judged(0.9, 0, 100, 2), Judged(0.8, 50, 150, 4), Judged(0.7, 75, 175, 6)}),
      (Scores{0.9, 0.7}));
}

TEST_F(ChooseCandidatesTest, WhatExplainsNothingIsLeftOut) {
  EXPECT_TRUE(ChosenScores({Judged(0.9, 0, 0, 2)}).empty());
}

TEST_F(ChooseCandidatesTest, CentresKeepTheirDistance) {
  // The diameter is 1.04 m: 0.42 m between two of a class, 0.21 m between two classes.
  EXPECT_EQ(ChosenScores({Judged(0.9, 0, 10, 2.0), Judged(0.8, 10, 20, 2.3)}), (Scores{0.9}));
  EXPECT_EQ(ChosenScores({Judged(0.9, 0, 10, 2.0), Judged(0.8, 10, 20, 2.5)}), (Scores{0.9, 0.8}));
  EXPECT_EQ(ChosenScores({Judged(0.9, 0, 10, 2.0), Judged(0.8, 10, 20, 2.3, 1)}),
            (Scores{0.9, 0.8}));
  EXPECT_EQ(ChosenScores({Judged(0.9, 0, 10, 2.0), Judged(0.8, 10, 20, 2.1, 1)}), (Scores{0.9}));
}

// --- finding -----------------------------------------------------------------------------------

const Eigen::Isometry3d kPose = Placed(2.2, 0.3, -1.1, 2.0);

// An armchair on a floor before a wall.
RangeImage ArmchairImage() {
  World world;
  world.planes = {{Eigen::Vector3d(0, 0, -1.1), Eigen::Vector3d::UnitZ()},
                  {Eigen::Vector3d(4, 0, 0), -Eigen::Vector3d::UnitX()}};
  Place(Armchair(), kPose, &world);
  return MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{}),
                        Params().range_image);
}

const ModelDatabase& ArmchairDatabase() {
  static const ModelDatabase database({BuildModel(Record(Armchair()), Params(), Execution{})},
                                      Params(), Execution{});
  return database;
}

// The steps up to the ranked hypotheses.
struct Steps {
  explicit Steps(const Execution& execution)
      : image(ArmchairImage()),
        scene(image, Params().evidence.normal_radius, execution),
        features(ExtractFeatures(image, Params(), execution)),
        matches(MatchToModels(features, ArmchairDatabase(), Params(), execution)),
        proposed(ProposeHypotheses(scene, features, matches, ArmchairDatabase(), Params(),
                                   execution, &num_found)),
        ranked(RankHypotheses(scene, proposed, ArmchairDatabase(), Params(), execution)) {}

  RangeImage image;
  Scene scene;
  FeatureSet features;
  ModelMatches matches;
  int num_found = 0;
  std::vector<Hypothesis> proposed, ranked;
};

template <typename List>
void ExpectBestFirst(const List& list) {
  for (std::size_t i = 1; i < list.size(); ++i) EXPECT_GE(list[i - 1].score, list[i].score);
}

TEST(DefaultMethodTest, TheTruePoseIsProposedRankedAndJudged) {
  const Steps steps(Execution{});
  EXPECT_GE(steps.num_found, static_cast<int>(steps.proposed.size()));
  EXPECT_LE(static_cast<int>(steps.proposed.size()), Params().ranking.refined.most);
  EXPECT_LE(static_cast<int>(steps.ranked.size()), Params().ranking.judged.most);
  ExpectBestFirst(steps.proposed);
  ExpectBestFirst(steps.ranked);
  const auto near = [](double distance, double angle) {
    return [=](const Hypothesis& h) {
      return PosesNear(h.T_sensor_object.cast<double>(), kPose, distance, angle);
    };
  };
  EXPECT_TRUE(std::any_of(steps.proposed.begin(), steps.proposed.end(), near(0.2, 0.4)));
  EXPECT_TRUE(std::any_of(steps.ranked.begin(), steps.ranked.end(), near(0.05, 0.1)));

  const std::vector<JudgedCandidate> judged =
      JudgeCandidates(steps.scene, steps.features, steps.matches, steps.ranked, ArmchairDatabase(),
                      Params(), Execution{});
  ASSERT_EQ(judged.size(), steps.ranked.size());
  const auto right = std::find_if(judged.begin(), judged.end(), [](const JudgedCandidate& j) {
    return PosesNear(j.candidate.T_sensor_object, kPose, 0.02, 0.04) &&
           j.evidence.values[kMatchedOfKnown] > 0.8;
  });
  ASSERT_NE(right, judged.end());
  EXPECT_GT(right->support.inside, 5);
  EXPECT_GT(right->support.matching, right->support.inside / 4);
  EXPECT_LE(right->support.matching, right->support.inside);
  for (std::size_t i = 1; i < judged.size(); ++i)
    EXPECT_GE(judged[i - 1].candidate.score, judged[i].candidate.score);
}

TEST(DefaultMethodTest, HypothesesOfOnePoseBecomeItsVotes) {
  const Steps steps(Execution{});
  ASSERT_FALSE(steps.ranked.empty());
  const auto most = std::max_element(
      steps.ranked.begin(), steps.ranked.end(),
      [](const Hypothesis& a, const Hypothesis& b) { return a.figures.votes < b.figures.votes; });
  EXPECT_TRUE(PosesNear(most->T_sensor_object.cast<double>(), kPose, 0.1, 0.2));
  double votes = 0.0;
  for (const Hypothesis& h : steps.ranked) votes += h.figures.votes;
  EXPECT_LE(votes, steps.num_found);
  for (std::size_t i = 0; i < steps.ranked.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(PosesNear(steps.ranked[i].T_sensor_object.cast<double>(),
                             steps.ranked[k].T_sensor_object.cast<double>(),
                             0.3 * Params().ranking.same_distance,
                             0.5 * Params().ranking.same_angle))
          << i << ' ' << k;
    }
  }
}

TEST(DefaultMethodTest, ThreadsDoNotMatter) {
  const Steps alone(Execution{}), other(OnThreads(4));
  EXPECT_EQ(alone.num_found, other.num_found);
  ASSERT_EQ(alone.ranked.size(), other.ranked.size());
  for (std::size_t i = 0; i < alone.ranked.size(); ++i) {
    EXPECT_EQ(alone.ranked[i].T_sensor_object.matrix(), other.ranked[i].T_sensor_object.matrix());
    EXPECT_EQ(alone.ranked[i].score, other.ranked[i].score);
  }
}

TEST(FindByEvidenceTest, TellsWhatItJudged) {
  const RangeImage image = ArmchairImage();
  const FeatureSet features = ExtractFeatures(image, Params(), Execution{});
  const JudgedScan found =
      FindByEvidence(image, features, ArmchairDatabase(), Params(), Execution{});
  EXPECT_EQ(found.num_pixels, image.grid().size());
  ASSERT_EQ(found.models.size(), 1u);
  EXPECT_EQ(found.models[0].name, ArmchairDatabase().models()[0].name);
  ASSERT_FALSE(found.candidates.empty());
  EXPECT_GE(found.num_found, static_cast<int>(found.candidates.size()));
  for (const ExplainingCandidate& item : found.candidates) {
    for (const PixelRun& run : item.explained) {
      EXPECT_GE(run.first, 0);
      EXPECT_LE(run.first + run.count, found.num_pixels);
    }
  }
}

TEST(DefaultMethodTest, WhatIsFoundOfAModelDoesNotDependOnTheOthers) {
  PipelineParams params = Params();
  params.ranking.num_models = 20;  // so that the work is shared equally in both databases
  const ModelDatabase alone({BuildModel(Record(Armchair()), params, Execution{})}, params,
                            Execution{});
  const ModelDatabase many(
      {BuildModel(Record(Armchair()), params, Execution{}),
       BuildModel(Record(Stool()), params, Execution{}), BoxModel("aaa", {0.6, 0.5, 0.4}, 0.03)},
      params, OnThreads(2));
  const RangeImage image = ArmchairImage();
  const FeatureSet features = ExtractFeatures(image, params, Execution{});
  const JudgedScan one = FindByEvidence(image, features, alone, params, Execution{});
  const JudgedScan all = FindByEvidence(image, features, many, params, OnThreads(2));
  ASSERT_FALSE(one.candidates.empty());
  std::vector<const ExplainingCandidate*> same;
  for (const ExplainingCandidate& candidate : all.candidates)
    if (all.models[candidate.candidate.model].name == one.models.front().name)
      same.push_back(&candidate);
  ASSERT_EQ(same.size(), one.candidates.size());
  EXPECT_GT(all.candidates.size(), one.candidates.size());
  for (std::size_t i = 0; i < same.size(); ++i) {
    EXPECT_EQ(same[i]->candidate.score, one.candidates[i].candidate.score);
    EXPECT_EQ(same[i]->rank_score, one.candidates[i].rank_score);
    EXPECT_EQ(same[i]->candidate.T_sensor_object.matrix(),
              one.candidates[i].candidate.T_sensor_object.matrix());
  }
}

}  // namespace
}  // namespace rimod
