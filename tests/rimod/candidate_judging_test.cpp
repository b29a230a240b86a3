#include "rimod/candidate_judging.h"

#include <gtest/gtest.h>

#include "rimod/default_method.h"
#include "rimod/feature_extraction.h"
#include "rimod/judgement.h"
#include "rimod/model_building.h"
#include "rimod/refinement.h"
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
  params.ranking.min_screened_score = 0.0;
  return params;
}

const ModelDatabase& ArmchairDatabase() {
  static const ModelDatabase database({BuildModel(Record(Armchair()), Params(), Execution{})},
                                      Params(), Execution{});
  return database;
}

// An armchair that leans (rad) on a floor before a wall.
struct LeaningArmchair {
  explicit LeaningArmchair(double tilt) : pose(Placed(2.2, 0.3, -1.1, 2.0)) {
    pose.rotate(Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()));
    World world;
    world.planes = {{Eigen::Vector3d(0, 0, -1.1), Eigen::Vector3d::UnitZ()},
                    {Eigen::Vector3d(4, 0, 0), -Eigen::Vector3d::UnitX()}};
    Place(Armchair(), pose, &world);
    image = MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{}),
                           Params().range_image);
    features = ExtractFeatures(image, Params(), Execution{});
  }

  std::vector<JudgedCandidate> Judge(const std::vector<Eigen::Isometry3d>& poses,
                                     const PipelineParams& params,
                                     const Execution& execution = {}) const {
    const Scene scene(image, params.evidence.normal_radius, execution);
    std::vector<Hypothesis> ranked(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
      ranked[i].T_sensor_object = poses[i].cast<float>();
    return JudgeCandidates(scene, features,
                           MatchToModels(features, ArmchairDatabase(), params, execution), ranked,
                           ArmchairDatabase(), params, execution);
  }

  JudgedCandidate JudgeOne(double upright_tilt, double min_leaning_odds) const {
    PipelineParams params = Params();
    params.refinement.upright_tilt = upright_tilt;
    params.refinement.min_leaning_odds = min_leaning_odds;
    return Judge({pose}, params).front();
  }

  Eigen::Isometry3d pose;
  RangeImage image;
  FeatureSet features;
};

double TiltOf(const JudgedCandidate& judged) {
  return rimod::TiltOf(judged.candidate.T_sensor_object.cast<float>());
}

constexpr double kTilt = 0.1;
constexpr double kLimit = 0.15;  // refinement.upright_tilt

TEST(CandidateJudgingTest, UprightUnlessLeaningIsFarMoreProbable) {
  const LeaningArmchair leaning(kTilt);
  const JudgedCandidate as_refined = leaning.JudgeOne(0.0, 1.0);
  const JudgedCandidate upright = leaning.JudgeOne(kLimit, 1e9);
  EXPECT_NEAR(TiltOf(as_refined), kTilt, 0.01);
  EXPECT_LT(TiltOf(upright), 1e-3);
  ASSERT_GT(as_refined.candidate.score, upright.candidate.score);
  const auto odds = [](const JudgedCandidate& j) {
    return j.candidate.score / (1.0 - j.candidate.score);
  };
  const double ratio = odds(as_refined) / odds(upright);
  EXPECT_GT(TiltOf(leaning.JudgeOne(kLimit, 0.99 * ratio)), 0.5 * kTilt);
  EXPECT_LT(TiltOf(leaning.JudgeOne(kLimit, 1.01 * ratio)), 1e-3);
}

TEST(CandidateJudgingTest, WhatIsToldIsOfThePoseThatIsTold) {
  const LeaningArmchair leaning(kTilt);
  const Scene scene(leaning.image, Params().evidence.normal_radius, Execution{});
  for (const double min_leaning_odds : {1.0, 1e9}) {
    const JudgedCandidate told = leaning.JudgeOne(kLimit, min_leaning_odds);
    EXPECT_EQ(TiltOf(told) < 1e-3, min_leaning_odds > 1.0);
    const Evidence evidence = GatherEvidence(scene, ArmchairDatabase().judged_models()[0],
                                             told.candidate.T_sensor_object, Params().evidence);
    EXPECT_EQ(told.evidence.values, evidence.values);
    EXPECT_EQ(told.evidence.explained, evidence.explained);
    EXPECT_EQ(told.candidate.score,
              Probability(kJudgementTrees, JudgementFigures(evidence, told.figures, told.support)));
  }
}

TEST(CandidateJudgingTest, WhatLeansMoreIsNotTurned) {
  const LeaningArmchair leaning(0.2);
  EXPECT_NEAR(TiltOf(leaning.JudgeOne(kLimit, 1e9)), 0.2, 0.02);
}

TEST(CandidateJudgingTest, WhatAFirstLookGivesUpStaysAsItSawIt) {
  const LeaningArmchair standing(0.0);
  PipelineParams params = Params();
  Eigen::Isometry3d start = standing.pose;
  start.pretranslate(Eigen::Vector3d(0.02, 0.03, 0.0));
  const JudgedCandidate closely = standing.Judge({start}, params).front();
  params.ranking.min_screened_score = 1.0;
  const JudgedCandidate given_up = standing.Judge({start}, params).front();
  const Scene scene(standing.image, params.evidence.normal_radius, Execution{});
  const Eigen::Isometry3f first =
      RefinePose(scene, ArmchairDatabase().judged_models()[0].coarse_sample(), start.cast<float>(),
                 params.refinement.BeforeScreening());
  EXPECT_EQ(given_up.candidate.T_sensor_object.matrix(), first.cast<double>().matrix());
  EXPECT_NE(closely.candidate.T_sensor_object.matrix(),
            given_up.candidate.T_sensor_object.matrix());
}

TEST(CandidateJudgingTest, ThreadsAndOrderDoNotMatter) {
  const LeaningArmchair leaning(0.03);
  std::vector<Eigen::Isometry3d> poses(12, leaning.pose);
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses[i].pretranslate(Eigen::Vector3d(0.0, 0.05 * static_cast<double>(i), 0.0));
  const std::vector<JudgedCandidate> alone = leaning.Judge(poses, Params());
  ASSERT_EQ(alone.size(), poses.size());
  EXPECT_GT(alone.front().candidate.score, alone.back().candidate.score);
  for (const Execution& execution : {OnThreads(4), Backwards()}) {
    const std::vector<JudgedCandidate> other = leaning.Judge(poses, Params(), execution);
    ASSERT_EQ(other.size(), alone.size());
    for (std::size_t i = 0; i < alone.size(); ++i) {
      EXPECT_EQ(other[i].candidate.score, alone[i].candidate.score);
      EXPECT_EQ(other[i].candidate.T_sensor_object.matrix(),
                alone[i].candidate.T_sensor_object.matrix());
    }
  }
}

}  // namespace
}  // namespace rimod
