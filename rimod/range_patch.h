#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "rimod/features.h"
#include "rimod/interest_points.h"
#include "rimod/range_image.h"

namespace rimod {

struct RangePatchParams {
  int resolution = 8;          // cells a side (paper, section IV); 2 .. 16
  double support_size = 0.35;  // m, width of the square (paper, section IV); 0.02 .. 2
  // m, the normal is that of the points this near. The paper takes the points of the support; half
  // its diagonal is that. 0.01 .. 2
  double normal_radius = 0.1;
  double normal_pixels = 0.0;  // .. but at least this many pixels reach far (m: times their size),
                               // for far surfaces; 0 .. 100
  int min_points = 8;          // measured points needed for a normal; >= 3
  // Cells that no point falls into: left out of the comparison, or at the patch's mean.
  bool mask_empty_cells = true;
  double max_vertical_cosine =
      0.966;  // normals nearer to the vertical (15 deg) have no horizontal of their own; 0 .. 1
  void Validate() const;
  // Name and parameters: features are comparable when these are equal.
  std::string Kind() const;
};

// The frame of a patch: z along the normal, x horizontal (paper, section III-A). Where the normal
// is nearly vertical x is orthogonal to the line of sight instead, to the viewer's right.
Eigen::Matrix3d PatchFrame(const Eigen::Vector3d& normal, const Eigen::Vector3d& line_of_sight,
                           double max_vertical_cosine);

// Normal of the plane through the points within the radius of the pixel's point, towards the
// sensor; nothing where too few points or a line only are there.
std::optional<Eigen::Vector3d> NormalAt(const RangeImage& image, const PixelIndex& pixel,
                                        double radius, int min_points);

// m, how far from the pixel's point those are that its normal and its patch depend on; spacing: m,
// between neighbouring measurements there.
double ReachOf(const RangePatchParams& params, double spacing);

// The normal-aligned range patch at a measured pixel: the surface within the support seen from
// along the normal, heights in cells, the mean subtracted (paper, section III-A). Nothing without a
// normal.
std::optional<Feature> DescribePatch(const RangeImage& image, const PixelIndex& pixel,
                                     const RangePatchParams& params);

}  // namespace rimod
