#pragma once

#include <vector>

#include "rimod/range_image.h"
#include "viewer_tools/palette.h"

namespace rimod {

// Ranges between which the colours change, m.
struct RangeSpan {
  double near = 0.5;
  double far = 5.0;
  // Equal ratios of ranges have equal shares: near things show as much relief as far ones.
  double Share(double range) const;
};

// The span of the ranges (m, in any order) but for these shares, 0 .. 1, of the nearest and the
// farthest. Without ranges: the default.
RangeSpan SpanOf(std::vector<float> ranges, double left_out_near, double left_out_far);

// The colour of a pixel of a range image at a canvas position; never observed outside the image.
Colour PixelColour(const RangeImage& image, int row, int column, const RangeSpan& span, int x,
                   int y);

}  // namespace rimod
