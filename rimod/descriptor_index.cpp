#include "rimod/descriptor_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

namespace rimod {
namespace {

constexpr int kLeafSize = 8;

float ToMetres(std::int16_t value) {
  return value == kEmptyCell ? 0.0f : static_cast<float>(value * kDescriptorUnit);
}

// A subtree still to be searched, with the smallest squared distance that anything in it can have.
struct Branch {
  double bound_sq = 0.0;
  int node = 0;
  bool operator<(const Branch& other) const {  // std::priority_queue serves the largest
    return bound_sq != other.bound_sq ? bound_sq > other.bound_sq : node > other.node;
  }
};

bool Nearer(const DescriptorMatch& a, const DescriptorMatch& b) {
  return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
}

}  // namespace

double DescriptorDistance(const Descriptor& a, const Descriptor& b, int min_shared) {
  std::int64_t sum = 0;
  int shared = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == kEmptyCell || b[i] == kEmptyCell) continue;
    const std::int64_t difference = a[i] - b[i];
    sum += difference * difference;
    ++shared;
  }
  if (shared < std::max(min_shared, 1)) return std::numeric_limits<double>::infinity();
  return kDescriptorUnit * std::sqrt(static_cast<double>(sum) / shared);
}

DescriptorIndex::DescriptorIndex(const std::vector<const Descriptor*>& descriptors)
    : size_(descriptors.empty() ? 0 : static_cast<int>(descriptors.front()->size())),
      order_(descriptors.size()) {
  values_.reserve(descriptors.size() * size_);
  for (const Descriptor* descriptor : descriptors)
    for (const std::int16_t value : *descriptor) {
      values_.push_back(ToMetres(value));
      filled_.push_back(value == kEmptyCell ? 0.0f : 1.0f);
    }
  std::iota(order_.begin(), order_.end(), 0);
  if (!order_.empty()) Build(0, size());
}

int DescriptorIndex::Build(int first, int last) {
  const int id = static_cast<int>(nodes_.size());
  nodes_.push_back({-1, 0.0f, -1, -1, first, last});
  if (last - first <= kLeafSize) return id;

  int dimension = 0;
  double best_variance = -1.0;
  for (int d = 0; d < size_; ++d) {
    double sum = 0.0, sum_sq = 0.0;
    for (int i = first; i < last; ++i) {
      const double value = Value(order_[i], d);
      sum += value;
      sum_sq += value * value;
    }
    const double mean = sum / (last - first);
    const double variance = sum_sq / (last - first) - mean * mean;
    if (variance > best_variance) {
      best_variance = variance;
      dimension = d;
    }
  }
  const int middle = (first + last) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [this, dimension](int a, int b) {
                     const float va = Value(a, dimension), vb = Value(b, dimension);
                     return va != vb ? va < vb : a < b;
                   });
  nodes_[id].dimension = dimension;
  nodes_[id].split = Value(order_[middle], dimension);
  const int left = Build(first, middle);
  const int right = Build(middle, last);
  nodes_[id].left = left;
  nodes_[id].right = right;
  return id;
}

double DescriptorIndex::DistanceSq(const std::vector<float>& query, int descriptor) const {
  const float* const values = &values_[static_cast<std::size_t>(descriptor) * size_];
  float sum_sq = 0.0f;
  for (int d = 0; d < size_; ++d) sum_sq += (query[d] - values[d]) * (query[d] - values[d]);
  return static_cast<double>(sum_sq) / size_;
}

double DescriptorIndex::SharedDistanceSq(const std::vector<float>& query,
                                         const std::vector<float>& query_filled, int descriptor,
                                         int min_shared) const {
  const float* const values = &values_[static_cast<std::size_t>(descriptor) * size_];
  const float* const filled = &filled_[static_cast<std::size_t>(descriptor) * size_];
  float sum_sq = 0.0f, shared = 0.0f;
  for (int d = 0; d < size_; ++d) {
    const float both = query_filled[d] * filled[d];
    const float difference = query[d] - values[d];
    sum_sq += both * difference * difference;
    shared += both;
  }
  if (shared < static_cast<float>(min_shared)) return std::numeric_limits<double>::infinity();
  return static_cast<double>(sum_sq / shared);
}

std::vector<DescriptorMatch> DescriptorIndex::FindNear(const Descriptor& query, int max_matches,
                                                       double max_distance, int max_checks,
                                                       int min_shared) const {
  std::vector<DescriptorMatch> found;
  if (nodes_.empty() || max_matches < 1 || static_cast<int>(query.size()) != size_) return found;
  std::vector<float> q(query.size());
  std::transform(query.begin(), query.end(), q.begin(), ToMetres);
  std::vector<float> filled(query.size());
  std::transform(query.begin(), query.end(), filled.begin(),
                 [](std::int16_t value) { return value == kEmptyCell ? 0.0f : 1.0f; });
  const double max_sq = max_distance * max_distance * size_;

  // The max_matches nearest so far, the farthest on top.
  double worst_sq = max_sq;
  const auto keep = [&](int index, double distance_sq) {
    if (distance_sq * size_ > worst_sq) return;
    const DescriptorMatch match{index, distance_sq};  // squared until the end
    if (static_cast<int>(found.size()) == max_matches) {
      if (!Nearer(match, found.front())) return;
      std::pop_heap(found.begin(), found.end(), Nearer);
      found.back() = match;
    } else {
      found.push_back(match);
    }
    std::push_heap(found.begin(), found.end(), Nearer);
    // Over shared cells alone distances may be smaller than the tree's bounds.
    if (min_shared == 0 && static_cast<int>(found.size()) == max_matches)
      worst_sq = std::min(worst_sq, found.front().distance * size_);
  };

  std::priority_queue<Branch> branches;
  branches.push({0.0, 0});
  int checks = 0;
  while (!branches.empty() && checks < max_checks) {
    const Branch branch = branches.top();
    branches.pop();
    if (branch.bound_sq > worst_sq) break;  // all others are farther, too
    int node = branch.node;
    while (nodes_[node].dimension >= 0) {
      const double gap = static_cast<double>(q[nodes_[node].dimension]) - nodes_[node].split;
      const int near = gap < 0.0 ? nodes_[node].left : nodes_[node].right;
      const int far = gap < 0.0 ? nodes_[node].right : nodes_[node].left;
      const double bound_sq = std::max(branch.bound_sq, gap * gap);
      if (bound_sq <= worst_sq) branches.push({bound_sq, far});
      node = near;
    }
    for (int i = nodes_[node].first; i < nodes_[node].last; ++i) {
      ++checks;
      const double distance_sq = min_shared > 0 ? SharedDistanceSq(q, filled, order_[i], min_shared)
                                                : DistanceSq(q, order_[i]);
      keep(order_[i], distance_sq);
    }
  }
  std::sort_heap(found.begin(), found.end(), Nearer);
  for (DescriptorMatch& match : found) match.distance = std::sqrt(match.distance);
  return found;
}

}  // namespace rimod
