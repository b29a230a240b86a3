#include "rimod/model_work.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace rimod {
namespace {

TEST(SharedAmongModelsTest, ManyModelsShareTheWork) {
  PipelineParams params = DefaultParams(Method::kDefault);
  params.matching.max_matches = 20;
  params.ranking.full_models = 8;
  params.ranking.min_screened_score = 0.003;
  params.ranking.refined = {40, 120, 0.005};
  params.ranking.num_models = 8;
  EXPECT_EQ(SharedAmongModels(params, 1).ranking.refined.most, 120);
  params.ranking.num_models = 32;
  const PipelineParams shared = SharedAmongModels(params, 1);
  EXPECT_EQ(shared.ranking.refined.always, 17);  // 40 / 4^0.65, no fractions lost
  EXPECT_EQ(shared.ranking.refined.most, 49);
  EXPECT_EQ(shared.ranking.refined.min_score, 0.005);
  EXPECT_EQ(shared.matching.max_matches, 9);  // of 20
  EXPECT_NEAR(shared.ranking.min_screened_score, 0.003 * std::pow(4.0, 0.65), 1e-9);
  params.ranking.num_models = 1'000'000;
  EXPECT_EQ(SharedAmongModels(params, 1).matching.max_matches, 2);
  EXPECT_EQ(SharedAmongModels(params, 1).ranking.min_screened_score, params.choice.min_probability);
  EXPECT_EQ(SharedAmongModels(params, 1).ranking.judged.always, 1);
  params.matching.max_matches = 1;  // as wanted
  EXPECT_EQ(SharedAmongModels(params, 1).matching.max_matches, 1);
  params.ranking.num_models = 0;  // as many as the database has: one
  EXPECT_EQ(SharedAmongModels(params, 1).ranking.refined.most, 120);
}

TEST(BestOfEachModelTest, TheBestGoOnAnywayMoreIfProbable) {
  std::vector<Hypothesis> hypotheses;
  for (const auto& [model, score] : std::vector<std::pair<int, double>>{
           {0, 0.9}, {0, 0.5}, {0, 0.4}, {0, 0.3}, {2, 0.01}, {2, 0.005}, {2, 0.001}}) {
    Hypothesis hypothesis;
    hypothesis.model = model;
    hypothesis.score = score;
    hypotheses.push_back(hypothesis);
  }
  const auto scores = [&](const ModelQuota& quota) {
    std::vector<double> kept;
    for (const Hypothesis& h : BestOfEachModel(hypotheses, quota)) kept.push_back(h.score);
    return kept;
  };
  EXPECT_EQ(scores({2, 3, 0.1}), (std::vector<double>{0.9, 0.5, 0.4, 0.01, 0.005}));
  EXPECT_EQ(scores({0, 9, 0.45}), (std::vector<double>{0.9, 0.5}));
  EXPECT_EQ(scores({1, 1, 0.0}), (std::vector<double>{0.9, 0.01}));
}

TEST(ForFeaturesTest, FewFeaturesGetMoreMatchesEach) {
  MatchingParams params;
  params.max_matches = 5;
  params.max_checks = 60;
  params.min_correspondences = 2500;
  EXPECT_EQ(ForFeatures(params, 1000).max_matches, 5);
  EXPECT_EQ(ForFeatures(params, 250).max_matches, 10);
  EXPECT_EQ(ForFeatures(params, 250).max_checks, 120);
  EXPECT_EQ(ForFeatures(params, 1).max_matches, 25);  // five times as many at most
  EXPECT_EQ(ForFeatures(params, 0).max_matches, 25);
  params.min_correspondences = 0;
  EXPECT_EQ(ForFeatures(params, 1).max_matches, 5);
}

}  // namespace
}  // namespace rimod
