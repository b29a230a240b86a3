#include "rimod/judgement.h"

// Written by experiments/train_judgement; docs/accuracy.md tells on what.

namespace rimod {

const LogisticWeights kRankWeights = {std::vector<double>(15, 0.0), std::vector<double>(15, 1.0),
                                      std::vector<double>(15, 0.0), 0.0};
const LogisticWeights kJudgementWeights = {
    std::vector<double>(33, 0.0), std::vector<double>(33, 1.0), std::vector<double>(33, 0.0), 0.0};

}  // namespace rimod
