#include "rimod/range_patch.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "rimod/check.h"
#include "rimod/neighbourhood.h"

namespace rimod {
namespace {

// Heights over the patch's plane, the highest point of each cell as seen from along the normal.
struct Heights {
  explicit Heights(int cells)
      : side(cells), values(cells * cells, 0.0f), filled(values.size(), 0) {}
  void Add(int cell, float height) {
    if (filled[cell] && values[cell] >= height) return;
    values[cell] = height;
    filled[cell] = 1;
  }
  int side;
  std::vector<float> values;
  std::vector<char> filled;
};

// A point covers the cells within half the distance to its neighbouring measurements.
void Splat(const Eigen::Vector3f& p_patch, float footprint, float cell, Heights* heights) {
  const float half = 0.5f * static_cast<float>(heights->side);
  const auto index = [cell, half](float coordinate) {
    return static_cast<int>(std::floor(coordinate / cell + half));
  };
  const int last = heights->side - 1;
  const int first_row = std::max(index(-p_patch.y() - footprint), 0);
  const int last_row = std::min(index(-p_patch.y() + footprint), last);
  const int first_column = std::max(index(p_patch.x() - footprint), 0);
  const int last_column = std::min(index(p_patch.x() + footprint), last);
  for (int row = first_row; row <= last_row; ++row)
    for (int column = first_column; column <= last_column; ++column)
      heights->Add(row * heights->side + column, p_patch.z());
}

Descriptor ToDescriptor(const Heights& heights, bool mask_empty_cells) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < heights.values.size(); ++i) {
    if (!heights.filled[i]) continue;
    sum += heights.values[i];
    ++count;
  }
  const double mean = count > 0 ? sum / count : 0.0;
  Descriptor descriptor(heights.values.size(), mask_empty_cells ? kEmptyCell : std::int16_t{0});
  for (std::size_t i = 0; i < heights.values.size(); ++i) {
    if (!heights.filled[i]) continue;
    const double steps = std::round((heights.values[i] - mean) / kDescriptorUnit);
    descriptor[i] = static_cast<std::int16_t>(std::clamp(steps, -32767.0, 32767.0));
  }
  return descriptor;
}

// m
double NormalRadius(const RangePatchParams& params, double spacing) {
  return std::max(params.normal_radius, params.normal_pixels * spacing);
}

// Of the square, m.
double HalfDiagonal(const RangePatchParams& params) { return params.support_size * std::sqrt(0.5); }

}  // namespace

void RangePatchParams::Validate() const {
  CheckWithin("range_patch resolution", resolution, 2, 16);
  CheckWithin("range_patch support_size", support_size, 0.02, 2.0);
  CheckWithin("range_patch normal_radius", normal_radius, 0.01, 2.0);
  CheckWithin("range_patch normal_pixels", normal_pixels, 0.0, 100.0);
  CheckWithin("range_patch min_points", min_points, 3, 10000);
  CheckWithin("range_patch max_vertical_cosine", max_vertical_cosine, 0.0, 1.0);
}

std::string RangePatchParams::Kind() const {
  std::ostringstream kind;
  kind << "range_patch " << resolution << "x" << resolution << " support " << support_size
       << " normal " << normal_radius << " or pixels " << normal_pixels << " vertical "
       << max_vertical_cosine << (mask_empty_cells ? " masked" : " filled");
  return kind.str();
}

Eigen::Matrix3d PatchFrame(const Eigen::Vector3d& normal, const Eigen::Vector3d& line_of_sight,
                           double max_vertical_cosine) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d x_axis = up.cross(normal);
  if (std::abs(normal.z()) > max_vertical_cosine) {
    const Eigen::Vector3d right = line_of_sight.cross(up);
    x_axis = right - right.dot(normal) * normal;
  }
  constexpr double kShort = 1e-6;
  if (x_axis.norm() < kShort) x_axis = Eigen::Vector3d::UnitX();
  Eigen::Matrix3d frame;
  frame.col(0) = x_axis.normalized();
  frame.col(1) = normal.cross(frame.col(0)).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

std::optional<Eigen::Vector3d> NormalAt(const RangeImage& image, const PixelIndex& pixel,
                                        double radius, int min_points) {
  const Eigen::Vector3d centre = image.point(pixel.row, pixel.column).cast<double>();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  int count = 0;
  VisitNeighbourhood(image, pixel, radius, [&](const Eigen::Vector3f& point, int) {
    const Eigen::Vector3d offset = point.cast<double>() - centre;
    sum += offset;
    products += offset * offset.transpose();
    ++count;
  });
  if (count < min_points) return std::nullopt;
  const Eigen::Vector3d mean = sum / count;
  const Eigen::Matrix3d covariance = products / count - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  constexpr double kLine = 1e-3;  // second axis this much shorter than the first: no plane
  if (!(solver.eigenvalues()(1) > kLine * solver.eigenvalues()(2))) return std::nullopt;
  const Eigen::Vector3d normal = solver.eigenvectors().col(0).normalized();
  return normal.dot(centre) > 0.0 ? Eigen::Vector3d(-normal) : normal;
}

double ReachOf(const RangePatchParams& params, double spacing) {
  return std::max(NormalRadius(params, spacing), HalfDiagonal(params));
}

std::optional<Feature> DescribePatch(const RangeImage& image, const PixelIndex& pixel,
                                     const RangePatchParams& params) {
  const double pixel_angle = PixelAngle(image.grid(), pixel.row, pixel.column);
  const double spacing = pixel_angle * image.range(pixel.row, pixel.column);
  const std::optional<Eigen::Vector3d> normal =
      NormalAt(image, pixel, NormalRadius(params, spacing), params.min_points);
  if (!normal) return std::nullopt;
  Feature feature;
  feature.position = image.point(pixel.row, pixel.column);
  feature.normal = normal->cast<float>();
  const Eigen::Matrix3f R_patch_sensor =
      PatchFrame(*normal, feature.position.cast<double>(), params.max_vertical_cosine)
          .transpose()
          .cast<float>();

  Heights heights(params.resolution);
  const double cell = params.support_size / params.resolution;
  VisitNeighbourhood(
      image, pixel, HalfDiagonal(params), [&](const Eigen::Vector3f& point, int step) {
        const Eigen::Vector3f p_patch = R_patch_sensor * (point - feature.position);
        const double footprint = 0.5 * step * pixel_angle * point.norm();
        Splat(p_patch, static_cast<float>(footprint), static_cast<float>(cell), &heights);
      });
  feature.descriptor = ToDescriptor(heights, params.mask_empty_cells);
  return feature;
}

}  // namespace rimod
