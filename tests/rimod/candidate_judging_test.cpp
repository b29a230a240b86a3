#include "rimod/candidate_judging.h"

#include <gtest/gtest.h>

#include "rimod/default_method.h"
#include "rimod/feature_extraction.h"
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
  const JudgedCandidate as_refined = leaning.JudgeOne(0.0, 1.0);
  const JudgedCandidate chosen = leaning.JudgeOne(kLimit, 1.0);
  EXPECT_EQ(chosen.candidate.score, as_refined.candidate.score);
  EXPECT_EQ(chosen.candidate.T_sensor_object.matrix(),
            as_refined.candidate.T_sensor_object.matrix());
  EXPECT_EQ(chosen.evidence.values, as_refined.evidence.values);
  EXPECT_EQ(chosen.evidence.explained, as_refined.evidence.explained);
  EXPECT_EQ(chosen.support.matching, as_refined.support.matching);
}

TEST(CandidateJudgingTest, WhatLeansMoreIsNotTurned) {
  const LeaningArmchair leaning(0.2);
  EXPECT_NEAR(TiltOf(leaning.JudgeOne(kLimit, 1e9)), 0.2, 0.02);
}

TEST(CandidateJudgingTest, WhatAFirstLookGivesUpIsNotRefinedFurther) {
  const LeaningArmchair standing(0.0);
  PipelineParams params = Params();
  Eigen::Isometry3d wrong = standing.pose;
  wrong.pretranslate(Eigen::Vector3d(0.0, -1.2, 0.0));
  const double patient = standing.Judge({standing.pose, wrong}, params).front().candidate.score;
  params.ranking.min_screened_score = 0.2;
  params.refinement.fine_iterations = 0;
  const std::vector<JudgedCandidate> judged =
      standing.Judge({wrong, standing.pose}, params, OnThreads(2));
  ASSERT_EQ(judged.size(), 2u);
  EXPECT_GT(patient, 0.2);
  EXPECT_TRUE(PosesNear(judged[0].candidate.T_sensor_object, standing.pose, 0.05, 0.05));
  EXPECT_LT(judged[1].candidate.score, 0.2);
}

}  // namespace
}  // namespace rimod
