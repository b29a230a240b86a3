#include "rimod/surface_thinning.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace rimod {
namespace {

struct Cell {
  std::int64_t x, y, z;
  bool operator==(const Cell& other) const { return x == other.x && y == other.y && z == other.z; }
};

Cell CellOf(const Eigen::Vector3f& point, double spacing) {
  const Eigen::Vector3d cell = point.cast<double>() / spacing;
  return {std::llround(cell.x()), std::llround(cell.y()), std::llround(cell.z())};
}

// The points kept so far by their cells: a hash table of chains.
class KeptPoints {
 public:
  explicit KeptPoints(std::size_t most) {
    std::size_t size = 1;
    while (size < most) size *= 2;
    first_.assign(size, -1);
  }

  // Keeps a point unless one of its cell and side is there.
  bool Add(const Cell& cell, const Eigen::Vector3f& normal) {
    constexpr float kSameSide = 0.5f;  // cosine
    int& first = first_[Hash(cell) & (first_.size() - 1)];
    for (int i = first; i >= 0; i = kept_[i].next)
      if (kept_[i].cell == cell && kept_[i].normal.dot(normal) > kSameSide) return false;
    kept_.push_back({cell, normal, first});
    first = static_cast<int>(kept_.size()) - 1;
    return true;
  }

 private:
  struct Kept {
    Cell cell;
    Eigen::Vector3f normal;
    int next = -1;  // of the same place in the table
  };

  static std::size_t Hash(const Cell& cell) {
    constexpr std::uint64_t kMixing = 0x9E3779B97F4A7C15u;  // golden ratio times 2^64
    std::uint64_t hash = 0;
    for (const std::int64_t c : {cell.x, cell.y, cell.z})
      hash = (hash ^ static_cast<std::uint64_t>(c)) * kMixing;
    return static_cast<std::size_t>(hash >> 32);
  }

  std::vector<int> first_;  // in kept_, -1: none
  std::vector<Kept> kept_;
};

}  // namespace

ObjectModel ThinSurface(const ObjectModel& model, double spacing) {
  ObjectModel thin;
  thin.name = model.name;
  thin.box_min = model.box_min;
  thin.box_max = model.box_max;
  thin.point_spacing = spacing;
  KeptPoints kept(model.points.size());
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    if (!kept.Add(CellOf(model.points[i], spacing), model.normals[i])) continue;
    thin.points.push_back(model.points[i]);
    thin.normals.push_back(model.normals[i]);
  }
  thin.points.shrink_to_fit();
  thin.normals.shrink_to_fit();
  return thin;
}

}  // namespace rimod
