#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "rimod/descriptor_projection.h"
#include "rimod/features.h"
#include "rimod/interest_points.h"
#include "rimod/range_image.h"

namespace rimod {

// Spherical spin images (Ruiz-Correa, Shapiro and Meila 2001), with which the paper compares its
// patches (section IV). A spin image (Johnson and Hebert 1999) counts the points around a surface
// point by their distance from its normal's line and their height over its tangent plane: turned
// about the normal it stays the same. Its values less their mean, divided by their standard
// deviation, are a point on a sphere; the distance of two such points depends on the linear
// correlation r of the two images alone, by which Johnson and Hebert compare them: nearest on the
// sphere is best correlated.
struct SphericalSpinParams {
  int resolution = 5;          // bins of distance and of height (paper, section IV); 2 .. 16
  double support_size = 0.6;   // m, diameter and height of the cylinder (paper); 0.02 .. 2
  int dimensions = 0;          // lowest frequencies kept of the image; 0 = all bins .. 255
  double normal_radius = 0.1;  // m, the normal is that of the points this near; 0.01 .. 2
  double normal_pixels = 2.0;  // .. but at least this many pixels reach far, for far surfaces (m:
                               // times their size); 0 .. 100
  int min_points = 8;          // measured points needed for a normal; >= 3
  void Validate() const;
  // Name and parameters: features are comparable when these are equal.
  std::string Kind() const;
  // Values of a descriptor: resolution^2, or those it is compressed to.
  int DescriptorSize() const;
};

// Radius of the sphere by the square root of the values: the root mean square difference of two
// descriptors is kSpinSpread * sqrt(2 (1 - r)), at any resolution. Small enough for a spin image
// of one filled bin of 16 x 16, large enough for kDescriptorUnit.
constexpr double kSpinSpread = 0.2;

// The spherical spin image of a surface point: rows from the highest to the lowest bin, columns
// from the normal's line outwards. Each point's count of one is shared by the four bins that it
// lies between. The normal is a unit vector; points that are not finite or outside do not count.
// Nothing where all bins are equal, empty ones included. Not compressed.
std::optional<Descriptor> SphericalSpinImage(const std::vector<Eigen::Vector3f>& points,
                                             const Eigen::Vector3f& position,
                                             const Eigen::Vector3f& normal,
                                             const SphericalSpinParams& params);

// m, how far from a pixel's point those are that its normal and its spin image depend on; spacing:
// m, between neighbouring measurements there.
double ReachOf(const SphericalSpinParams& params, double spacing);

// Describes pixels of range images by spherical spin images, compressed as the parameters say.
class SphericalSpinDescriber {
 public:
  explicit SphericalSpinDescriber(const SphericalSpinParams& params);

  // At a measured pixel, of the points around it that the image shows. Nothing without a normal.
  std::optional<Feature> operator()(const RangeImage& image, const PixelIndex& pixel) const;

 private:
  Descriptor Compress(const Descriptor& spin_image) const;

  SphericalSpinParams params_;
  std::optional<DescriptorProjection> projection_;
};

}  // namespace rimod
