#pragma once

#include <cstdint>
#include <vector>

namespace rimod {

// What the shape of the disagreement between a rendered model and the scene tells: an object that
// is smaller than the model, or of another outline, is seen through along whole sides.

enum class PixelFit : std::uint8_t {
  kNotRendered,
  kUnknown,  // occluded, without a return, or neither here nor there
  kFits,
  kSeenThrough,
};

// Row by row.
struct FitImage {
  int width = 0, height = 0;  // pixels
  std::vector<PixelFit> pixels;
};

// Shares seen through of the pixels just inside the silhouette, by the side that they lie on.
struct RimFit {
  double worst = 0.0;         // largest of the known sides'; 0 without any
  double second_worst = 0.0;  // .. and of the others'; 0 with one or none
  double mean = 0.0;          // over all sides' pixels
};

// inset: pixels between the rim looked at and the outermost, which the background shines through;
// >= 0. Parts of the model that are no wider than twice that have no rim.
RimFit FitOfRim(const FitImage& fits, int inset);

// Pixels of the largest connected (by their sides) region that is seen through; the outermost
// rendered pixels, which the background shines through, do not count.
int LargestSeenThroughRegion(const FitImage& fits);

}  // namespace rimod
