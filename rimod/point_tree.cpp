#include "rimod/point_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <utility>

namespace rimod {
namespace {

// nanoflann's view of a point list.
struct PointList {
  const std::vector<Eigen::Vector3d>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t d) const { return points[i][d]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointList>,
                                                 PointList, 3, std::size_t>;

}  // namespace

struct PointTree::Impl {
  explicit Impl(std::vector<Eigen::Vector3d> given)
      : points(std::move(given)), list{points}, tree(3, list) {}
  std::vector<Eigen::Vector3d> points;
  PointList list;
  Tree tree;
};

PointTree::PointTree(std::vector<Eigen::Vector3d> points)
    : impl_(std::make_unique<Impl>(std::move(points))) {}
PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

const std::vector<Eigen::Vector3d>& PointTree::points() const { return impl_->points; }

std::vector<int> PointTree::Within(const Eigen::Vector3d& query, double radius) const {
  std::vector<std::pair<std::size_t, double>> matches;
  if (!points().empty())
    impl_->tree.radiusSearch(query.data(), radius * radius, matches, nanoflann::SearchParams());
  std::vector<int> indices;
  indices.reserve(matches.size());
  for (const auto& match : matches) indices.push_back(static_cast<int>(match.first));
  std::sort(indices.begin(), indices.end());
  return indices;
}

double PointTree::DistanceToNearest(const Eigen::Vector3d& query, int k) const {
  if (points().size() < static_cast<std::size_t>(k)) return std::numeric_limits<double>::infinity();
  std::vector<std::size_t> indices(k);
  std::vector<double> distances_sq(k);
  impl_->tree.knnSearch(query.data(), k, indices.data(), distances_sq.data());
  return std::sqrt(distances_sq.back());
}

}  // namespace rimod
