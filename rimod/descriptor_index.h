#pragma once

#include <cstdint>
#include <vector>

#include "rimod/features.h"

namespace rimod {

// A descriptor of the index and how far it is from the one looked for.
struct DescriptorMatch {
  int index = 0;          // in the order in which the descriptors were given
  double distance = 0.0;  // m, root mean square over the compared cells
};

// Root mean square difference of two descriptors over the cells that both have, in metres; infinite
// when they share fewer than min_shared cells.
double DescriptorDistance(const Descriptor& a, const Descriptor& b, int min_shared);

// Finds near descriptors by best-bins-first search in a kd-tree (paper, section III-A; Beis and
// Lowe), empty cells standing at the mean. Own tree, since FLANN's draw their splits from the
// hardware's randomness: here equal input gives equal trees and equal answers.
class DescriptorIndex {
 public:
  // All of one size; may be empty.
  explicit DescriptorIndex(const std::vector<const Descriptor*>& descriptors);

  // The nearest of the descriptors that were looked at, at most max_matches within max_distance,
  // nearest first, ties by index. Looks at max_checks descriptors at least when there are as many;
  // as many checks as descriptors make the search exact. With min_shared > 0 the distance is
  // DescriptorDistance's, over the cells that both have; the tree is searched as before.
  std::vector<DescriptorMatch> FindNear(const Descriptor& query, int max_matches,
                                        double max_distance, int max_checks,
                                        int min_shared = 0) const;

  int size() const { return static_cast<int>(order_.size()); }

 private:
  struct Node {
    int dimension = -1;  // -1: a leaf
    float split = 0.0f;  // smaller values go left
    int left = -1, right = -1;
    int first = 0, last = 0;  // leaf: range in order_
  };
  int Build(int first, int last);
  // Mean squared difference over all cells, or over those that both have; m^2.
  double DistanceSq(const std::vector<float>& query, int descriptor) const;
  double SharedDistanceSq(const std::vector<float>& query, const std::vector<float>& query_filled,
                          int descriptor, int min_shared) const;
  float Value(int descriptor, int dimension) const {
    return values_[static_cast<std::size_t>(descriptor) * size_ + dimension];
  }

  int size_ = 0;               // values a descriptor
  std::vector<float> values_;  // m, descriptor by descriptor
  std::vector<float> filled_;  // likewise, 1 where the cell is not empty, else 0
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace rimod
