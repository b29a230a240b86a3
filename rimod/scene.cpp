#include "rimod/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "rimod/fast_atan2.h"
#include "rimod/plane_normal.h"
#include "rimod/wide_loops.h"

namespace rimod {
namespace {

using Lanes = Eigen::Array4f;
constexpr int kLanes = 4;

// Sums over offsets, m, in four lanes each.
struct OffsetSums {
  Lanes count = Lanes::Zero();
  std::array<Lanes, 3> offsets = {Lanes::Zero(), Lanes::Zero(), Lanes::Zero()};
  std::array<Lanes, 6> products = {Lanes::Zero(), Lanes::Zero(), Lanes::Zero(), Lanes::Zero(),
                                   Lanes::Zero(), Lanes::Zero()};  // xx xy xz yy yz zz
  void Add(Lanes x, Lanes y, Lanes z, float radius_sq) {
    const Lanes distance_sq = x * x + y * y + z * z;
    Lanes weight;
    for (int lane = 0; lane < kLanes; ++lane)
      weight[lane] = distance_sq[lane] <= radius_sq ? 1.0f : 0.0f;
    count += weight;
    x *= weight;
    y *= weight;
    z *= weight;
    offsets[0] += x;
    offsets[1] += y;
    offsets[2] += z;
    products[0] += x * x;
    products[1] += x * y;
    products[2] += x * z;
    products[3] += y * y;
    products[4] += y * z;
    products[5] += z * z;
  }
  Eigen::Matrix3f Covariance() const {
    const float n = count.sum();
    const Eigen::Vector3f mean =
        Eigen::Vector3f(offsets[0].sum(), offsets[1].sum(), offsets[2].sum()) / n;
    Eigen::Matrix3f mean_products;
    const float xy = products[1].sum(), xz = products[2].sum(), yz = products[4].sum();
    mean_products << products[0].sum(), xy, xz, xy, products[3].sum(), yz, xz, yz,
        products[5].sum();
    return mean_products / n - mean * mean.transpose();
  }
};

// Normal at a measured pixel from the pixels around it, as far as radius reaches, at most the
// grid's margin.
Eigen::Vector3f NormalOf(const RangeImage& image, const PointGrid& points, int row, int column,
                         float radius) {
  constexpr int kSamples = 2;  // looks at about (2 * kSamples + 1)^2 pixels
  constexpr int kMostAcross = 2 * PointGrid::kMargin + 1;
  constexpr float kMinPoints = 5.0f;
  const Eigen::Vector3f& centre = image.point(row, column);
  const float pixel =
      static_cast<float>(PixelAngle(image.grid(), row, column)) * image.range(row, column);
  const int reach = std::clamp(static_cast<int>(radius / pixel), 1, PointGrid::kMargin);
  const int step = std::max(1, reach / kSamples);
  const float radius_sq = std::max(radius * radius, 8.0f * pixel * pixel);
  const float beyond = 2.0f * std::sqrt(radius_sq);  // what fills up a row's last lanes
  std::array<float, kMostAcross + kLanes> x, y, z;
  OffsetSums sums;
  for (int r = row - reach; r <= row + reach; r += step) {
    int across = 0;
    for (int c = column - reach; c <= column + reach; c += step, ++across) {
      const std::size_t place = points.Place(r, c);
      x[across] = *points.x(place) - centre.x();
      y[across] = *points.y(place) - centre.y();
      z[across] = *points.z(place) - centre.z();
    }
    std::fill_n(&x[across], kLanes, beyond);
    std::fill_n(&y[across], kLanes, 0.0f);
    std::fill_n(&z[across], kLanes, 0.0f);
    for (int i = 0; i < across; i += kLanes) {
      sums.Add(Eigen::Map<const Lanes>(&x[i]), Eigen::Map<const Lanes>(&y[i]),
               Eigen::Map<const Lanes>(&z[i]), radius_sq);
    }
  }
  if (sums.count.sum() < kMinPoints) return Eigen::Vector3f::Zero();
  const Eigen::Vector3f normal = PlaneNormal(sums.Covariance());
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

PointGrid::PointGrid(const RangeImage& image)
    : stride_(static_cast<std::size_t>(image.width()) + 2 * kMargin) {
  constexpr float kVeryFar = 1e18f;  // m; its square is still a float
  for (std::vector<float>* const column : {&points_.x, &points_.y, &points_.z})
    column->assign(stride_ * (static_cast<std::size_t>(image.height()) + 2 * kMargin), kVeryFar);
  for (int row = 0; row < image.height(); ++row) {
    for (int column = 0; column < image.width(); ++column) {
      if (!image.measured(row, column)) continue;
      const Eigen::Vector3f& point = image.point(row, column);
      const std::size_t place = Place(row, column);
      points_.x[place] = point.x();
      points_.y[place] = point.y();
      points_.z[place] = point.z();
    }
  }
}

Scene::Scene(const RangeImage& image, double normal_radius, const Execution& execution,
             const Scene& before, const ImageChange& change)
    : Scene(image) {
  FillPixels(normal_radius, execution, change.everything() ? nullptr : &before, change);
}

Scene::Scene(const RangeImage& image, double normal_radius, const Execution& execution)
    : Scene(image) {
  FillPixels(normal_radius, execution, nullptr, ImageChange());
}

Scene::Scene(const RangeImage& image)
    : image_(image),
      points_(image),
      T_axis_sensor_(Eigen::Matrix3f(AxisFromSensor(image.grid()).cast<float>())),
      left_(static_cast<float>(image.grid().left)),
      top_(static_cast<float>(image.grid().top)),
      pixels_per_unit_(image.grid().size() > 0 ? static_cast<float>(1.0 / image.grid().resolution)
                                               : 0.0f),
      width_(image.width()),
      height_(image.height()),
      ranges_(static_cast<std::size_t>(image.grid().size()), 0.0f),
      normals_(ranges_.size(), Eigen::Vector3f::Zero()) {}

void Scene::FillPixels(double normal_radius, const Execution& execution, const Scene* before,
                       const ImageChange& change) {
  execution.parallel_for(static_cast<std::size_t>(height_), [&](std::size_t i) {
    const int row = static_cast<int>(i);
    for (int column = 0; column < width_; ++column) {
      const int pixel = row * width_ + column;
      if (image_.pixel(row, column) == Pixel::kNoReturn) {
        ranges_[pixel] = std::numeric_limits<float>::infinity();
      } else if (image_.measured(row, column)) {
        ranges_[pixel] = image_.range(row, column);
        const bool known = before && !change.TouchesPixels(row, column, PointGrid::kMargin);
        normals_[pixel] =
            known ? before->normal((row - change.row_shift()) * before->width_ + column -
                                   change.column_shift())
                  : NormalOf(image_, points_, row, column, static_cast<float>(normal_radius));
      }
    }
  });
}

void Scene::Project(const PointColumns& points, const Eigen::Isometry3f& T_sensor_object,
                    std::size_t begin, std::size_t end, ProjectedPoints* projected) const {
  projected->pixels.resize(std::max(projected->pixels.size(), end));
  projected->ranges.resize(projected->pixels.size());
  if (grid().projection == Projection::kPinhole) {
    ProjectPinhole(points, T_axis_sensor_ * T_sensor_object, begin, end, projected);
  } else {
    ProjectSpherical(points, T_sensor_object, begin, end, projected);
  }
}

RIMOD_WIDE_LOOPS void Scene::ProjectSpherical(const PointColumns& points,
                                              const Eigen::Isometry3f& T_sensor_object,
                                              std::size_t begin, std::size_t end,
                                              ProjectedPoints* projected) const {
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
    const float column = (left_ - FastAtan2(y, x)) * pixels_per_unit_;
    const float row = (top_ - FastAtan2(z, std::sqrt(horizontal_sq))) * pixels_per_unit_;
    const bool inside = (row >= 0.0f) & (row < height) & (column >= 0.0f) & (column < width);
    const int r = static_cast<int>(inside ? row : 0.0f);
    const int c = static_cast<int>(inside ? column : 0.0f);
    pixels[i] = inside ? r * width_ + c : -1;
  }
}

RIMOD_WIDE_LOOPS void Scene::ProjectPinhole(const PointColumns& points,
                                            const Eigen::Isometry3f& T_axis_object,
                                            std::size_t begin, std::size_t end,
                                            ProjectedPoints* projected) const {
  constexpr float kMinCosine = static_cast<float>(kMinPinholeCosine), kTiny = 1e-30f;
  const Eigen::Matrix3f R = T_axis_object.linear();
  const Eigen::Vector3f t = T_axis_object.translation();
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
    const float range = std::sqrt(x * x + y * y + z * z);
    ranges[i] = range;
    const float per_depth = 1.0f / (x > kTiny ? x : kTiny);
    const float column = (left_ - y * per_depth) * pixels_per_unit_;
    const float row = (top_ - z * per_depth) * pixels_per_unit_;
    const bool inside = (x > kMinCosine * range) & (row >= 0.0f) & (row < height) &
                        (column >= 0.0f) & (column < width);
    const int r = static_cast<int>(inside ? row : 0.0f);
    const int c = static_cast<int>(inside ? column : 0.0f);
    pixels[i] = inside ? r * width_ + c : -1;
  }
}

int Scene::NearestPixel(int pixel, const Eigen::Vector3f& p, float gate) const {
  using Coordinates = Eigen::Map<const Lanes>;  // three lanes are used
  const int row = pixel / width_, column = pixel % width_;
  std::size_t place = points_.Place(row - 1, column - 1);
  std::array<Lanes, 3> distances_sq;
  for (Lanes& line : distances_sq) {
    line = (Coordinates(points_.x(place)) - p.x()).square() +
           (Coordinates(points_.y(place)) - p.y()).square() +
           (Coordinates(points_.z(place)) - p.z()).square();
    place += points_.stride();
  }
  // Without branches, which processors would guess wrong: any pixel may be the nearest.
  const Lanes nearest = distances_sq[0].min(distances_sq[1]).min(distances_sq[2]);
  const float smallest = std::min(std::min(nearest[0], nearest[1]), nearest[2]);
  if (!(smallest < gate * gate)) return -1;
  const int lane = (nearest[0] != smallest) * (1 + (nearest[1] != smallest));
  const int line = (distances_sq[0][lane] != smallest) * (1 + (distances_sq[1][lane] != smallest));
  return (row + line - 1) * width_ + column + lane - 1;
}

}  // namespace rimod
