#include "rimod/judgement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/io/random_values.h"

namespace rimod {
namespace {

Evidence RandomEvidence(RandomValues* random) {
  Evidence evidence;
  for (double& value : evidence.values) value = random->Between(0.0, 1.0);
  return evidence;
}

RankingFigures RandomFigures(RandomValues* random) {
  RankingFigures figures;
  for (float* figure : {&figures.at_place, &figures.hits, &figures.looked_through, &figures.known,
                        &figures.agreeing, &figures.goes_on, &figures.jumps})
    *figure = static_cast<float>(random->Between(0.0, 1.0));
  figures.pixels_across = static_cast<float>(random->Between(0.0, 300.0));
  figures.votes = static_cast<float>(random->Between(1.0, 50.0));
  return figures;
}

TEST(ProbabilityTest, IsTheLogisticFunctionOfStandardisedFigures) {
  const LogisticWeights weights{{1.0, 0.0}, {2.0, 0.5}, {3.0, -1.0}, 0.25};
  EXPECT_NEAR(Probability(weights, {1.0, 0.0}), 1.0 / (1.0 + std::exp(-0.25)), 1e-12);
  EXPECT_NEAR(Probability(weights, {3.0, 1.0}), 1.0 / (1.0 + std::exp(-1.25)), 1e-12);
  EXPECT_NEAR(Probability(weights, {1000.0, 0.0}), 1.0, 1e-12);
  EXPECT_NEAR(Probability(weights, {-1000.0, 0.0}), 0.0, 1e-12);
}

TEST(ProbabilityTest, IsTheLogisticFunctionOfTheLeavesOfTheTrees) {
  // The first tree asks for figure 0, then 1; the second is a leaf.
  BoostedTrees trees;
  trees.bias = 0.5;
  trees.roots = {0, 5};
  trees.nodes = {{0, 1.0, 1, 2, 0.0},  {-1, 0.0, 0, 0, -2.0}, {1, 0.0, 3, 4, 0.0},
                 {-1, 0.0, 0, 0, 1.0}, {-1, 0.0, 0, 0, 3.0},  {-1, 0.0, 0, 0, 0.25}};
  const auto logistic = [](double x) { return 1.0 / (1.0 + std::exp(-x)); };
  EXPECT_NEAR(Probability(trees, {0.0, 7.0}), logistic(0.5 - 2.0 + 0.25), 1e-12);
  EXPECT_NEAR(Probability(trees, {1.0, 7.0}), logistic(0.5 - 2.0 + 0.25), 1e-12);  // at: left
  EXPECT_NEAR(Probability(trees, {1.1, 0.0}), logistic(0.5 + 1.0 + 0.25), 1e-12);
  EXPECT_NEAR(Probability(trees, {1.1, 0.1}), logistic(0.5 + 3.0 + 0.25), 1e-12);
  EXPECT_NEAR(Probability(BoostedTrees{}, {}), 0.5, 1e-12);
}

void ExpectUsable(const LogisticWeights& weights, std::size_t figures) {
  ASSERT_EQ(weights.means.size(), figures);
  ASSERT_EQ(weights.scales.size(), figures);
  ASSERT_EQ(weights.weights.size(), figures);
  EXPECT_TRUE(std::isfinite(weights.bias));
  for (std::size_t i = 0; i < figures; ++i) {
    EXPECT_TRUE(std::isfinite(weights.means[i]) && std::isfinite(weights.weights[i])) << i;
    EXPECT_TRUE(std::isfinite(weights.scales[i]) && weights.scales[i] > 0.0) << i;
  }
}

TEST(LearntWeightsTest, FitTheFigures) {
  ExpectUsable(kProposalWeights, RankFigures(RankingFigures{}).size());
  ExpectUsable(kRankWeights, RankFigures(RankingFigures{}).size());
}

TEST(LearntTreesTest, FitTheFiguresAndEnd) {
  const int figures =
      static_cast<int>(JudgementFigures(Evidence{}, RankingFigures{}, FeatureSupport{}).size());
  const int size = static_cast<int>(kJudgementTrees.nodes.size());
  EXPECT_FALSE(kJudgementTrees.roots.empty());
  EXPECT_TRUE(std::isfinite(kJudgementTrees.bias));
  for (const int root : kJudgementTrees.roots) EXPECT_TRUE(root >= 0 && root < size);
  for (int i = 0; i < size; ++i) {
    const TreeNode& node = kJudgementTrees.nodes[i];
    EXPECT_TRUE(std::isfinite(node.threshold) && std::isfinite(node.value)) << i;
    if (node.feature < 0) continue;
    EXPECT_LT(node.feature, figures) << i;
    // Children come after their parent: no path runs in circles.
    EXPECT_TRUE(node.left > i && node.left < size && node.right > i && node.right < size) << i;
  }
}

TEST(LearntWeightsTest, GiveProbabilitiesForAnyFigures) {
  RandomValues random(1);
  for (int i = 0; i < 200; ++i) {
    const RankingFigures figures = i == 0 ? RankingFigures{} : RandomFigures(&random);
    for (const LogisticWeights& weights : {kProposalWeights, kRankWeights}) {
      const double rank = Probability(weights, RankFigures(figures));
      EXPECT_TRUE(rank >= 0.0 && rank <= 1.0) << rank;
    }
    const Evidence evidence = i == 0 ? Evidence{} : RandomEvidence(&random);
    const FeatureSupport support{i, i / 2};
    const double judged =
        Probability(kJudgementTrees, JudgementFigures(evidence, figures, support));
    EXPECT_TRUE(judged >= 0.0 && judged <= 1.0) << judged;
  }
}

}  // namespace
}  // namespace rimod
