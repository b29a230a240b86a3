#pragma once

#include <string>
#include <vector>

#include "rimod/evidence.h"
#include "rimod/feature_support.h"
#include "rimod/hypothesis_ranking.h"

namespace rimod {

// What figures mean: probabilities by logistic regression or boosted trees, one set of weights for
// all classes. The weights stand in judgement_weights.cpp and are learnt by
// experiments/train_judgement (docs/accuracy.md).

// Weights of a logistic regression over standardised figures.
struct LogisticWeights {
  std::vector<double> means, scales, weights;
  double bias = 0.0;
};

// One node of a decision tree: figures at or below the threshold go left. Leaves have feature -1.
struct TreeNode {
  int feature = -1;
  double threshold = 0.0;
  int left = 0, right = 0;  // in BoostedTrees::nodes
  double value = 0.0;       // of a leaf: what it adds to the logit
};

// Gradient-boosted decision trees: the logit is the sum of a bias and of one leaf a tree.
struct BoostedTrees {
  double bias = 0.0;
  std::vector<int> roots;
  std::vector<TreeNode> nodes;
};

// Probability for figures of the same number as the weights, or as the trees were learnt on.
double Probability(const LogisticWeights& weights, const std::vector<double>& figures);
double Probability(const BoostedTrees& trees, const std::vector<double>& figures);

// The figures that a hypothesis is scored and ranked by: what is known of it, and ratios of that.
std::vector<double> RankFigures(const RankingFigures& figures);

// The figures that a detection is judged by: the evidence, its products with the object's size in
// the image, the rank's, and the support.
std::vector<double> JudgementFigures(const Evidence& evidence, const RankingFigures& figures,
                                     const FeatureSupport& support);

extern const LogisticWeights kProposalWeights;  // before refinement
extern const LogisticWeights kRankWeights;      // after it
extern const BoostedTrees kJudgementTrees;

}  // namespace rimod
