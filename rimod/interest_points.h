#pragma once

#include <string>
#include <vector>

#include "rimod/range_image.h"

namespace rimod {

struct PixelIndex {
  int row = 0;
  int column = 0;
  bool operator==(const PixelIndex& other) const {
    return row == other.row && column == other.column;
  }
};

// What makes a pixel interesting.
enum class InterestMeasure {
  kHarris,         // corner strength of the range image (paper, section III-A; Harris and Stephens)
  kSurfaceChange,  // bends of the surface and the near side of depth jumps
};

struct InterestPointParams {
  InterestMeasure measure = InterestMeasure::kHarris;
  int max_points = 1200;   // the strongest are kept; >= 1
  int harris_window = 3;   // pixels, side of the window that gradients are summed over; 2 .. 15
  double harris_k = 0.04;  // Harris' trace weight; 0 .. 0.25
  double max_depth_jump = 0.3;  // m, larger differences to a neighbour count as this much; > 0
  double bend_step = 0.05;      // m, distance over which bends are measured (surface change); > 0
  double min_strength = 1e-6;   // weaker points are left out; >= 0
  double suppression_radius =
      0.05;                   // m, only the strongest point within this distance is kept; >= 0
  double cube_side = 0.25;    // m, of the cubes of space in which points are counted; > 0
  int max_points_a_cube = 0;  // the strongest in a cube are kept; 0: all
  double max_range = 30.0;    // m, farther points are left out; > 0
  void Validate() const;      // throws std::invalid_argument naming field and value
  std::string Kind() const;   // all of it in words: equal when the points found are
};

// The interest points of a range image, strongest first, ties by position in the image; measured
// pixels only. Empty for an image without measured pixels.
std::vector<PixelIndex> FindInterestPoints(const RangeImage& image,
                                           const InterestPointParams& params,
                                           const Execution& execution = {});

}  // namespace rimod
