#include "rimod/judged_model.h"

#include <algorithm>
#include <array>
#include <utility>

#include "rimod/surface_thinning.h"

namespace rimod {
namespace {

constexpr float kSurfaceCell = 0.025f;   // m, cells that tell what lies on the surface
constexpr double kSampleSpacing = 0.03;  // m, of the points for refinement ..
constexpr double kCoarseSpacing = 0.06;  // m, .. and for a first one

}  // namespace

JudgedModel::JudgedModel(const ObjectModel& model) : model_(&model) {
  const auto sample = [&](double spacing) {
    ObjectModel thin = ThinSurface(model, std::max(spacing, model.point_spacing));
    return SurfaceSample{std::move(thin.points), std::move(thin.normals)};
  };
  sample_ = sample(kSampleSpacing);
  coarse_sample_ = sample(kCoarseSpacing);
  for (const double factor : {1.6, 2.5, 4.0})
    thinned_.push_back(ThinSurface(model, factor * model.point_spacing));

  grid_origin_ = model.box_min.cast<float>().array() - 2 * kSurfaceCell;
  const Eigen::Vector3d extent = (model.box_max - model.box_min) / kSurfaceCell;
  for (int d = 0; d < 3; ++d) grid_size_[d] = static_cast<int>(std::min(extent[d], 400.0)) + 5;
  // The cells that hold points, with a margin of one, grown by one along each axis in turn.
  const Eigen::Vector3i margin = Eigen::Vector3i::Ones();
  const Eigen::Vector3i size = grid_size_ + 2 * margin;
  std::vector<char> cells(static_cast<std::size_t>(size[0]) * size[1] * size[2], 0);
  const std::array<std::size_t, 3> steps = {static_cast<std::size_t>(size[1]) * size[2],
                                            static_cast<std::size_t>(size[2]), 1};
  for (const Eigen::Vector3f& point : model.points) {
    const Eigen::Vector3i cell =
        ((point - grid_origin_) / kSurfaceCell).array().floor().cast<int>() + margin.array();
    if ((cell.array() < 0).any() || (cell.array() >= size.array()).any()) continue;
    cells[cell[0] * steps[0] + cell[1] * steps[1] + cell[2]] = 1;
  }
  for (const std::size_t step : steps) {
    const std::vector<char> before = cells;
    for (std::size_t i = step; i + step < cells.size(); ++i)
      cells[i] = static_cast<char>(before[i - step] | before[i] | before[i + step]);
  }
  near_surface_.reserve(static_cast<std::size_t>(grid_size_[0]) * grid_size_[1] * grid_size_[2]);
  for (int x = 1; x <= grid_size_[0]; ++x)
    for (int y = 1; y <= grid_size_[1]; ++y)
      for (int z = 1; z <= grid_size_[2]; ++z)
        near_surface_.push_back(cells[x * steps[0] + y * steps[1] + z] != 0);
}

const ObjectModel& JudgedModel::Thinned(double pixel_size) const {
  const ObjectModel* best = model_;
  for (const ObjectModel& thin : thinned_)
    if (thin.point_spacing <= pixel_size) best = &thin;
  return *best;
}

bool JudgedModel::OnSurface(const Eigen::Vector3f& p_object) const {
  const Eigen::Vector3i cell =
      ((p_object - grid_origin_) / kSurfaceCell).array().floor().cast<int>();
  if ((cell.array() < 0).any() || (cell.array() >= grid_size_.array()).any()) return false;
  return near_surface_[(static_cast<std::size_t>(cell[0]) * grid_size_[1] + cell[1]) *
                           grid_size_[2] +
                       cell[2]];
}

}  // namespace rimod
