#include "rimod/descriptor_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace rimod {
namespace {

constexpr int kLeafSize = 8;
constexpr std::size_t kBranches = 128;  // room for those of a search
constexpr int kLanes = 4;               // values that processors work on at once

// Equal to float(value * kDescriptorUnit) for every value (a test compares), but divisions of
// floats are vectorised.
float ToMetres(std::int16_t value) {
  constexpr float kStepsPerMetre = 10000.0f;
  static_assert(kDescriptorUnit * 10000 == 1.0, "the inverse of the unit");
  return value == kEmptyCell ? 0.0f : static_cast<float>(value) / kStepsPerMetre;
}

// A subtree still to be searched, with the smallest squared distance that anything in it can have.
struct Branch {
  double bound_sq = 0.0;
  int node = 0;
  bool operator<(const Branch& other) const {  // heaps have the largest on top
    return bound_sq != other.bound_sq ? bound_sq > other.bound_sq : node > other.node;
  }
};

// A lambda, not a function: the heaps' loops have it inlined.
constexpr auto Nearer = [](const DescriptorMatch& a, const DescriptorMatch& b) {
  return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
};

// Nodes of the tree over so many descriptors. Halving gives pieces of two sizes at each level.
int NumNodes(int count) {
  int size = count;  // of the smaller pieces; the larger ones have one more
  int num_small = 1, num_large = 0;
  int total = 0;
  while (num_small + num_large > 0) {
    total += num_small + num_large;
    if (size <= kLeafSize) num_small = 0;
    if (size + 1 <= kLeafSize) num_large = 0;
    const int small = size % 2 == 0 ? 2 * num_small + num_large : num_small;
    const int large = size % 2 == 0 ? num_large : num_small + 2 * num_large;
    num_small = small;
    num_large = large;
    size /= 2;
  }
  return total;
}

std::vector<std::int16_t> Flat(const std::vector<const Descriptor*>& descriptors) {
  std::vector<std::int16_t> values;
  if (!descriptors.empty()) values.reserve(descriptors.size() * descriptors.front()->size());
  for (const Descriptor* descriptor : descriptors)
    values.insert(values.end(), descriptor->begin(), descriptor->end());
  return values;
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

struct DescriptorIndex::Piece {
  int node = 0;
  int first = 0, last = 0;
};

DescriptorIndex::DescriptorIndex(const std::vector<const Descriptor*>& descriptors,
                                 const Execution& execution)
    : DescriptorIndex(Flat(descriptors),
                      descriptors.empty() ? 1 : static_cast<int>(descriptors.front()->size()),
                      execution) {}

DescriptorIndex::DescriptorIndex(std::vector<std::int16_t> values, int size,
                                 const Execution& execution)
    : size_(size), stride_((size + kLanes - 1) / kLanes * kLanes) {
  if (size < 1 || values.size() % static_cast<std::size_t>(size) != 0)
    throw std::invalid_argument("descriptors of size " + std::to_string(size) + " cannot have " +
                                std::to_string(values.size()) + " values");
  const std::size_t count = values.size() / static_cast<std::size_t>(size);
  if (stride_ == size_) {
    values_ = std::move(values);
  } else {
    values_.assign(count * stride_, 0);
    for (std::size_t i = 0; i < count; ++i)
      std::copy_n(&values[i * size_], size_, &values_[i * stride_]);
  }
  has_empty_cells_ = std::find(values_.begin(), values_.end(), kEmptyCell) != values_.end();
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0);
  if (count > 0) Build(execution);
}

// Level by level while there are few pieces, then piece by piece.
void DescriptorIndex::Build(const Execution& execution) {
  constexpr std::size_t kManyPieces = 64;
  nodes_.resize(static_cast<std::size_t>(NumNodes(size())));
  std::vector<Piece> pieces = {{0, 0, size()}};
  while (!pieces.empty() && pieces.size() < kManyPieces) {
    std::vector<std::vector<Piece>> halves(pieces.size());
    execution.parallel_for(pieces.size(), [&](std::size_t i) { halves[i] = Halves(pieces[i]); });
    pieces.clear();
    for (const std::vector<Piece>& two : halves)
      pieces.insert(pieces.end(), two.begin(), two.end());
  }
  execution.parallel_for(pieces.size(), [&](std::size_t i) { BuildAll(pieces[i]); });
}

void DescriptorIndex::BuildAll(const Piece& piece) {
  for (const Piece& half : Halves(piece)) BuildAll(half);
}

// Writes the piece's node; returns what lies below it.
std::vector<DescriptorIndex::Piece> DescriptorIndex::Halves(const Piece& piece) {
  Node& node = nodes_[piece.node];
  if (piece.last - piece.first <= kLeafSize) {
    node = {-1, 0.0f, piece.first, piece.last};
    return {};
  }
  const int middle = piece.first + (piece.last - piece.first) / 2;
  const int dimension = WidestDimension(piece.first, piece.last);
  Sort(piece.first, middle, piece.last, dimension);
  const int left = piece.node + 1;
  const int right = left + NumNodes(middle - piece.first);
  node = {dimension, ToMetres(ValuesAt(middle)[dimension]), right, 0};
  return {{left, piece.first, middle}, {right, middle, piece.last}};
}

// That of the largest variance, the first of equals.
int DescriptorIndex::WidestDimension(int first, int last) const {
  std::vector<double> sums(2 * static_cast<std::size_t>(size_), 0.0);
  double* const sum = sums.data();
  double* const sum_sq = sum + size_;
  for (int place = first; place < last; ++place) {
    const std::int16_t* const values = ValuesAt(place);
    for (int d = 0; d < size_; ++d) {
      const double value = ToMetres(values[d]);
      sum[d] += value;
      sum_sq[d] += value * value;
    }
  }
  const double count = last - first;
  int widest = 0;
  double largest = -1.0;
  for (int d = 0; d < size_; ++d) {
    const double mean = sum[d] / count;
    const double variance = sum_sq[d] / count - mean * mean;
    if (variance <= largest) continue;
    largest = variance;
    widest = d;
  }
  return widest;
}

// Places before the middle get what is smaller along the dimension, ties by number.
void DescriptorIndex::Sort(int first, int middle, int last, int dimension) {
  struct Key {
    float value;
    int descriptor, place;
  };
  std::vector<Key> keys(static_cast<std::size_t>(last - first));
  for (int place = first; place < last; ++place)
    keys[place - first] = {ToMetres(ValuesAt(place)[dimension]), order_[place], place};
  std::nth_element(keys.begin(), keys.begin() + (middle - first), keys.end(),
                   [](const Key& a, const Key& b) {
                     return a.value != b.value ? a.value < b.value : a.descriptor < b.descriptor;
                   });
  std::vector<std::int16_t> sorted(keys.size() * stride_);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    std::copy_n(ValuesAt(keys[i].place), stride_, &sorted[i * stride_]);
    order_[first + static_cast<int>(i)] = keys[i].descriptor;
  }
  std::copy(sorted.begin(), sorted.end(),
            values_.begin() + static_cast<std::ptrdiff_t>(first) * stride_);
}

// What is looked for, in the forms in which it is compared.
struct DescriptorIndex::Query {
  Query(const Descriptor& descriptor, int stride)
      : values(3 * static_cast<std::size_t>(stride), 0.0f),
        metres(values.data()),
        filled(metres + stride),
        steps(filled + stride) {
    for (std::size_t d = 0; d < descriptor.size(); ++d) {
      if (descriptor[d] == kEmptyCell) continue;
      values[d] = ToMetres(descriptor[d]);
      values[d + stride] = 1.0f;
      values[d + 2 * static_cast<std::size_t>(stride)] = descriptor[d];
    }
  }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  std::vector<float> values;
  const float* const metres;  // 0 for empty cells
  const float* const filled;  // 1, 0 for empty cells
  const float* const steps;   // kDescriptorUnit, 0 for empty cells
};

double DescriptorIndex::DistanceSq(const Query& query, int place) const {
  const std::int16_t* const values = ValuesAt(place);
  float sum_sq = 0.0f;
  for (int d = 0; d < size_; ++d) {
    const float difference = query.metres[d] - ToMetres(values[d]);
    sum_sq += difference * difference;
  }
  return static_cast<double>(sum_sq) / size_;
}

float DescriptorIndex::RoughSumSq(const Query& query, int place) const {
  const std::int16_t* const values = ValuesAt(place);
  const float* const steps = query.steps;
  float sums[kLanes] = {};
  const auto add = [&](const auto& value_of) {
    for (int d = 0; d < stride_; d += kLanes) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const float difference = steps[d + lane] - static_cast<float>(value_of(values[d + lane]));
        sums[lane] += difference * difference;
      }
    }
  };
  if (has_empty_cells_) {
    add([](std::int16_t value) { return value == kEmptyCell ? 0 : value; });
  } else {
    add([](std::int16_t value) { return value; });
  }
  constexpr float kUnitSq = static_cast<float>(kDescriptorUnit * kDescriptorUnit);
  return kUnitSq * ((sums[0] + sums[1]) + (sums[2] + sums[3]));
}

double DescriptorIndex::SharedDistanceSq(const Query& query, int place, int min_shared) const {
  const std::int16_t* const values = ValuesAt(place);
  float sum_sq = 0.0f, shared = 0.0f;
  for (int d = 0; d < size_; ++d) {
    const float both = values[d] == kEmptyCell ? 0.0f : query.filled[d];
    const float difference = query.metres[d] - ToMetres(values[d]);
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
  const Query q(query, stride_);
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
  // Far more than rounding makes of any sum; the second part counts for the smallest.
  constexpr double kRoughFactor = 1.001, kRoughOffset = 1e-9;  // m^2

  std::vector<Branch> branches;  // the nearest on top
  branches.reserve(kBranches);
  branches.push_back({0.0, 0});
  int checks = 0;
  while (!branches.empty() && checks < max_checks) {
    const Branch branch = branches.front();
    std::pop_heap(branches.begin(), branches.end());
    branches.pop_back();
    if (branch.bound_sq > worst_sq) break;  // all others are farther, too
    int node = branch.node;
    while (nodes_[node].dimension >= 0) {
      const double gap = static_cast<double>(q.metres[nodes_[node].dimension]) - nodes_[node].split;
      const int near = gap < 0.0 ? node + 1 : nodes_[node].right;
      const int far = gap < 0.0 ? nodes_[node].right : node + 1;
      const double bound_sq = std::max(branch.bound_sq, gap * gap);
      if (bound_sq <= worst_sq) {
        branches.push_back({bound_sq, far});
        std::push_heap(branches.begin(), branches.end());
      }
      node = near;
    }
    for (int place = nodes_[node].right; place < nodes_[node].last; ++place) {
      ++checks;
      if (min_shared > 0) {
        keep(order_[place], SharedDistanceSq(q, place, min_shared));
      } else if (RoughSumSq(q, place) <= kRoughFactor * worst_sq + kRoughOffset) {
        keep(order_[place], DistanceSq(q, place));
      }
    }
  }
  std::sort_heap(found.begin(), found.end(), Nearer);
  for (DescriptorMatch& match : found) match.distance = std::sqrt(match.distance);
  return found;
}

}  // namespace rimod
