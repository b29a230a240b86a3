#include "rimod/scene.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "rimod/fast_atan2.h"

namespace rimod {
namespace {

// Normal at a pixel from the pixels around it, as far as radius reaches, at most kMaxReach.
Eigen::Vector3f NormalOf(const RangeImage& image, int row, int column, float radius) {
  constexpr int kMaxReach = 6, kSamples = 2;  // pixels; looks at (2 * kSamples + 1)^2 of them
  constexpr int kMinPoints = 5;
  const Eigen::Vector3f& centre = image.point(row, column);
  const float pixel = static_cast<float>(image.grid().resolution) * image.range(row, column);
  const int reach = std::clamp(static_cast<int>(radius / pixel), 1, kMaxReach);
  const int step = std::max(1, reach / kSamples);
  const float radius_sq = std::max(radius * radius, 8.0f * pixel * pixel);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f products = Eigen::Matrix3f::Zero();
  int count = 0;
  for (int r = row - reach; r <= row + reach; r += step) {
    for (int c = column - reach; c <= column + reach; c += step) {
      if (!image.grid().Contains(r, c) || !image.measured(r, c)) continue;
      const Eigen::Vector3f offset = image.point(r, c) - centre;
      if (offset.squaredNorm() > radius_sq) continue;
      sum += offset;
      products += offset * offset.transpose();
      ++count;
    }
  }
  if (count < kMinPoints) return Eigen::Vector3f::Zero();
  const Eigen::Vector3f mean = sum / static_cast<float>(count);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(products / static_cast<float>(count) - mean * mean.transpose());
  const Eigen::Vector3f normal = solver.eigenvectors().col(0).normalized();
  if (!normal.allFinite()) return Eigen::Vector3f::Zero();
  return normal.dot(centre) > 0.0f ? Eigen::Vector3f(-normal) : normal;
}

}  // namespace

PointColumns::PointColumns(const std::vector<Eigen::Vector3f>& points) {
  for (std::vector<float>* const column : {&x, &y, &z}) column->reserve(points.size());
  for (const Eigen::Vector3f& point : points) Add(point);
}

void PointColumns::Add(const Eigen::Vector3f& point) {
  x.push_back(point.x());
  y.push_back(point.y());
  z.push_back(point.z());
}

Scene::Scene(const RangeImage& image, double normal_radius, const Execution& execution)
    : image_(image),
      azimuth_left_(static_cast<float>(image.grid().azimuth_left)),
      elevation_top_(static_cast<float>(image.grid().elevation_top)),
      pixels_per_radian_(image.grid().size() > 0 ? static_cast<float>(1.0 / image.grid().resolution)
                                                 : 0.0f),
      width_(image.width()),
      height_(image.height()),
      ranges_(static_cast<std::size_t>(image.grid().size()), 0.0f),
      normals_(ranges_.size(), Eigen::Vector3f::Zero()) {
  execution.parallel_for(static_cast<std::size_t>(height_), [&](std::size_t i) {
    const int row = static_cast<int>(i);
    for (int column = 0; column < width_; ++column) {
      const int pixel = row * width_ + column;
      if (image_.pixel(row, column) == Pixel::kNoReturn) {
        ranges_[pixel] = std::numeric_limits<float>::infinity();
      } else if (image_.measured(row, column)) {
        ranges_[pixel] = image_.range(row, column);
        normals_[pixel] = NormalOf(image_, row, column, static_cast<float>(normal_radius));
      }
    }
  });
}

void Scene::Project(const PointColumns& points, const Eigen::Isometry3f& T_sensor_object,
                    std::size_t begin, std::size_t end, ProjectedPoints* projected) const {
  projected->pixels.resize(std::max(projected->pixels.size(), end));
  projected->ranges.resize(projected->pixels.size());
  const Eigen::Matrix3f R = T_sensor_object.linear();
  const Eigen::Vector3f t = T_sensor_object.translation();
  const float* const px = points.x.data();
  const float* const py = points.y.data();
  const float* const pz = points.z.data();
  int* const pixels = projected->pixels.data();
  float* const ranges = projected->ranges.data();
  const float height = static_cast<float>(height_), width = static_cast<float>(width_);
  for (std::size_t i = begin; i < end; ++i) {
    const float x = R(0, 0) * px[i] + R(0, 1) * py[i] + R(0, 2) * pz[i] + t.x();
    const float y = R(1, 0) * px[i] + R(1, 1) * py[i] + R(1, 2) * pz[i] + t.y();
    const float z = R(2, 0) * px[i] + R(2, 1) * py[i] + R(2, 2) * pz[i] + t.z();
    const float horizontal_sq = x * x + y * y;
    ranges[i] = std::sqrt(horizontal_sq + z * z);
    const float column = (azimuth_left_ - FastAtan2(y, x)) * pixels_per_radian_;
    const float row =
        (elevation_top_ - FastAtan2(z, std::sqrt(horizontal_sq))) * pixels_per_radian_;
    const bool inside = (row >= 0.0f) & (row < height) & (column >= 0.0f) & (column < width);
    const int r = static_cast<int>(inside ? row : 0.0f);
    const int c = static_cast<int>(inside ? column : 0.0f);
    pixels[i] = inside ? r * width_ + c : -1;
  }
}

}  // namespace rimod
