#pragma once

#include <cstdint>
#include <vector>

#include "rimod/execution.h"
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
  explicit DescriptorIndex(const std::vector<const Descriptor*>& descriptors,
                           const Execution& execution = {});
  // The same from descriptors one after the other, of so many values each; size >= 1.
  DescriptorIndex(std::vector<std::int16_t> values, int size, const Execution& execution);

  // The nearest of the descriptors that were looked at, at most max_matches within max_distance,
  // nearest first, ties by index. Looks at max_checks descriptors at least when there are as many;
  // as many checks as descriptors make the search exact. With min_shared > 0 the distance is
  // DescriptorDistance's, over the cells that both have; the tree is searched as before.
  std::vector<DescriptorMatch> FindNear(const Descriptor& query, int max_matches,
                                        double max_distance, int max_checks,
                                        int min_shared = 0) const;

  int size() const { return static_cast<int>(order_.size()); }

 private:
  // The left child of node i is i + 1.
  struct Node {
    int dimension = -1;  // -1: a leaf
    float split = 0.0f;  // smaller values go left
    int right = 0;       // child; of a leaf: its first place
    int last = 0;        // of a leaf: the place behind its last one
  };
  struct Piece;  // of the places, to be made a subtree
  struct Query;
  void Build(const Execution& execution);
  std::vector<Piece> Halves(const Piece& piece);
  void BuildAll(const Piece& piece);
  int WidestDimension(int first, int last) const;
  void Sort(int first, int middle, int last, int dimension);

  // Mean squared difference over all cells, or over those that both have; m^2.
  double DistanceSq(const Query& query, int place) const;
  double SharedDistanceSq(const Query& query, int place, int min_shared) const;
  // Sum of the squared differences over all cells, m^2, good to a millionth.
  float RoughSumSq(const Query& query, int place) const;
  const std::int16_t* ValuesAt(int place) const {
    return &values_[static_cast<std::size_t>(place) * stride_];
  }

  int size_ = 0;    // values a descriptor
  int stride_ = 0;  // places of a descriptor in values_, those beyond its size are 0
  // Descriptors lie in the order of the leaves, so that a leaf is read in one go: these are places.
  std::vector<std::int16_t> values_;
  bool has_empty_cells_ = false;
  std::vector<int> order_;  // which descriptor has a place
  std::vector<Node> nodes_;
};

}  // namespace rimod
