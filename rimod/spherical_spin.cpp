#include "rimod/spherical_spin.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "rimod/check.h"
#include "rimod/neighbourhood.h"
#include "rimod/range_patch.h"

namespace rimod {
namespace {

// Counts of points, each shared by the bins that it lies between.
class SpinImage {
 public:
  SpinImage(int side, double support_size)
      : side_(side),
        radius_(0.5 * support_size),
        counts_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.0) {}

  // From the surface point; m.
  void Add(const Eigen::Vector3d& offset, const Eigen::Vector3d& normal) {
    const double height = offset.dot(normal);                   // Johnson and Hebert's beta
    const double distance = (offset - height * normal).norm();  // .. and alpha
    const double column = side_ * distance / radius_ - 0.5;     // 0 = middle of the first bin
    const double row = side_ * (radius_ - height) / (2.0 * radius_) - 0.5;
    // Negated so that what is no number is left out, too.
    if (!(column < side_ && row > -1.0 && row < side_)) return;
    const int left = static_cast<int>(std::floor(column)), top = static_cast<int>(std::floor(row));
    const double to_right = column - left, to_bottom = row - top;
    AddTo(top, left, (1.0 - to_bottom) * (1.0 - to_right));
    AddTo(top, left + 1, (1.0 - to_bottom) * to_right);
    AddTo(top + 1, left, to_bottom * (1.0 - to_right));
    AddTo(top + 1, left + 1, to_bottom * to_right);
  }

  // On the sphere.
  std::optional<Descriptor> Normalised() const {
    const double size = static_cast<double>(counts_.size());
    double mean = 0.0, variance = 0.0;
    for (const double count : counts_) mean += count / size;
    for (const double count : counts_) variance += (count - mean) * (count - mean) / size;
    constexpr double kRounding = 1e-12;  // of equal counts
    if (!(variance > kRounding * mean * mean)) return std::nullopt;
    const double scale = kSpinSpread / kDescriptorUnit / std::sqrt(variance);
    Descriptor descriptor;
    descriptor.reserve(counts_.size());
    for (const double count : counts_) {
      const double steps = std::round(scale * (count - mean));
      descriptor.push_back(static_cast<std::int16_t>(std::clamp(steps, -32767.0, 32767.0)));
    }
    return descriptor;
  }

 private:
  // Bins outside get nothing; beyond the normal's line is the first bin again.
  void AddTo(int row, int column, double count) {
    if (row < 0 || row >= side_ || column >= side_) return;
    counts_[row * side_ + std::max(column, 0)] += count;
  }

  int side_;
  double radius_;  // m, also half the height
  std::vector<double> counts_;
};

// m, no point farther off counts: half a bin outside of the cylinder's rim.
double Reach(const SphericalSpinParams& params) {
  const double half_bin = 0.5 * params.support_size / params.resolution;
  const double radius = 0.5 * params.support_size;
  return std::hypot(radius + 0.5 * half_bin, radius + half_bin);
}

}  // namespace

void SphericalSpinParams::Validate() const {
  CheckWithin("spherical_spin resolution", resolution, 2, 16);
  CheckWithin("spherical_spin support_size", support_size, 0.02, 2.0);
  CheckWithin("spherical_spin dimensions", dimensions, 0, 255);
  CheckWithin("spherical_spin normal_radius", normal_radius, 0.01, 2.0);
  CheckWithin("spherical_spin normal_pixels", normal_pixels, 0.0, 100.0);
  CheckWithin("spherical_spin min_points", min_points, 3, 10000);
}

std::string SphericalSpinParams::Kind() const {
  std::ostringstream kind;
  kind << "spherical_spin " << resolution << "x" << resolution << " support " << support_size
       << " normal " << normal_radius << " or pixels " << normal_pixels << " of " << min_points;
  if (dimensions > 0) kind << " compressed to " << DescriptorSize();
  return kind.str();
}

int SphericalSpinParams::DescriptorSize() const {
  const int bins = resolution * resolution;
  return dimensions > 0 ? std::min(dimensions, bins - 1) : bins;
}

std::optional<Descriptor> SphericalSpinImage(const std::vector<Eigen::Vector3f>& points,
                                             const Eigen::Vector3f& position,
                                             const Eigen::Vector3f& normal,
                                             const SphericalSpinParams& params) {
  SpinImage spin_image(params.resolution, params.support_size);
  for (const Eigen::Vector3f& point : points)
    spin_image.Add((point - position).cast<double>(), normal.cast<double>());
  return spin_image.Normalised();
}

double ReachOf(const SphericalSpinParams& params, double spacing) {
  return std::max({params.normal_radius, params.normal_pixels * spacing, Reach(params)});
}

SphericalSpinDescriber::SphericalSpinDescriber(const SphericalSpinParams& params)
    : params_((params.Validate(), params)) {
  if (params.dimensions > 0) projection_.emplace(params.resolution, params.DescriptorSize());
}

std::optional<Feature> SphericalSpinDescriber::operator()(const RangeImage& image,
                                                          const PixelIndex& pixel) const {
  const double spacing =
      PixelAngle(image.grid(), pixel.row, pixel.column) * image.range(pixel.row, pixel.column);
  const double normal_radius = std::max(params_.normal_radius, params_.normal_pixels * spacing);
  const std::optional<Eigen::Vector3d> normal =
      NormalAt(image, pixel, normal_radius, params_.min_points);
  if (!normal) return std::nullopt;
  Feature feature;
  feature.position = image.point(pixel.row, pixel.column);
  feature.normal = normal->cast<float>();
  std::vector<Eigen::Vector3f> points;
  points.reserve(kMaxNeighbourhoodSide * kMaxNeighbourhoodSide);
  VisitNeighbourhood(image, pixel, Reach(params_),
                     [&](const Eigen::Vector3f& point, int) { points.push_back(point); });
  const std::optional<Descriptor> spin_image =
      SphericalSpinImage(points, feature.position, feature.normal, params_);
  if (!spin_image) return std::nullopt;
  feature.descriptor = projection_ ? Compress(*spin_image) : *spin_image;
  return feature;
}

// Scaled, so that distances keep their size: root mean squares over fewer values.
Descriptor SphericalSpinDescriber::Compress(const Descriptor& spin_image) const {
  Descriptor compressed = projection_->Project(spin_image);
  const double scale = std::sqrt(static_cast<double>(compressed.size())) / params_.resolution;
  for (std::int16_t& value : compressed)
    value = static_cast<std::int16_t>(std::round(scale * value));
  return compressed;
}

}  // namespace rimod
