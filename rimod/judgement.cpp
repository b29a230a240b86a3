#include "rimod/judgement.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace rimod {
namespace {

// Keeps ratios of small shares tame.
constexpr double kSmallShare = 0.05;

}  // namespace

double Probability(const LogisticWeights& weights, const std::vector<double>& figures) {
  assert(figures.size() == weights.weights.size());
  double sum = weights.bias;
  for (std::size_t i = 0; i < figures.size(); ++i)
    sum += weights.weights[i] * (figures[i] - weights.means[i]) / weights.scales[i];
  return 1.0 / (1.0 + std::exp(-sum));
}

double Probability(const BoostedTrees& trees, const std::vector<double>& figures) {
  double sum = trees.bias;
  for (const int root : trees.roots) {
    const TreeNode* node = &trees.nodes[root];
    while (node->feature >= 0)
      node = &trees.nodes[figures[node->feature] <= node->threshold ? node->left : node->right];
    sum += node->value;
  }
  return 1.0 / (1.0 + std::exp(-sum));
}

std::vector<double> RankFigures(const RankingFigures& f) {
  const double size = std::log(std::max(f.pixels_across, 1.0f));
  return {f.at_place,
          f.hits,
          f.looked_through,
          f.known,
          f.agreeing,
          f.goes_on,
          f.jumps,
          size,
          f.at_place * size,
          f.agreeing * size,
          f.looked_through / (f.known + kSmallShare),
          f.agreeing / (f.hits + kSmallShare),
          f.at_place / (f.known + kSmallShare),
          f.hits / (f.known + kSmallShare),
          f.goes_on / (f.goes_on + f.jumps + kSmallShare),
          f.tilt,
          f.descriptor_distance,
          std::log(f.votes)};
}

std::vector<double> JudgementFigures(const Evidence& evidence, const RankingFigures& f,
                                     const FeatureSupport& support) {
  std::vector<double> figures(evidence.values.begin(), evidence.values.end());
  const double size = evidence.values[kLogMatchedPixels];
  for (const EvidenceIndex index : {kMatched, kSeenThrough, kMatchedOfKnown, kSilhouetteContinues,
                                    kSilhouetteKnown, kUnexplained, kNormalAgreement, kResidual})
    figures.push_back(evidence.values[index] * size);
  for (const double value :
       {double{f.at_place}, double{f.looked_through}, f.agreeing / (f.hits + kSmallShare),
        f.goes_on / (f.goes_on + f.jumps + kSmallShare), static_cast<double>(std::log(f.votes))})
    figures.push_back(value);
  figures.push_back(std::log1p(support.inside));
  figures.push_back(std::log1p(support.matching));
  figures.push_back(static_cast<double>(support.matching) / (support.inside + 1));
  return figures;
}

}  // namespace rimod
