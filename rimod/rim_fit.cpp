#include "rimod/rim_fit.h"

#include <algorithm>
#include <array>

namespace rimod {
namespace {

struct Side {
  int known = 0, seen_through = 0;
  void Add(PixelFit fit) {
    known += fit == PixelFit::kFits || fit == PixelFit::kSeenThrough;
    seen_through += fit == PixelFit::kSeenThrough;
  }
};

// The rims at both ends of each run of rendered pixels along a line of pixels.
void AddRims(const FitImage& fits, int start, int step, int count, int inset, Side* first,
             Side* last) {
  const auto at = [&](int i) { return fits.pixels[start + i * step]; };
  int begin = 0;
  for (int i = 0; i <= count; ++i) {
    if (i < count && at(i) != PixelFit::kNotRendered) continue;
    if (i - begin > 2 * inset) {
      first->Add(at(begin + inset));
      last->Add(at(i - 1 - inset));
    }
    begin = i + 1;
  }
}

bool IsRendered(const FitImage& fits, int row, int column) {
  return row >= 0 && row < fits.height && column >= 0 && column < fits.width &&
         fits.pixels[row * fits.width + column] != PixelFit::kNotRendered;
}

}  // namespace

RimFit FitOfRim(const FitImage& fits, int inset) {
  std::array<Side, 4> sides;
  for (int row = 0; row < fits.height; ++row)
    AddRims(fits, row * fits.width, 1, fits.width, inset, &sides[0], &sides[1]);
  for (int column = 0; column < fits.width; ++column)
    AddRims(fits, column, fits.width, fits.height, inset, &sides[2], &sides[3]);
  RimFit rim;
  int known = 0, seen_through = 0;
  for (const Side& side : sides) {
    known += side.known;
    seen_through += side.seen_through;
    constexpr int kMinPixels = 3;
    if (side.known < kMinPixels) continue;
    const double share = static_cast<double>(side.seen_through) / side.known;
    rim.second_worst = std::max(rim.second_worst, std::min(share, rim.worst));
    rim.worst = std::max(rim.worst, share);
  }
  if (known > 0) rim.mean = static_cast<double>(seen_through) / known;
  return rim;
}

int LargestSeenThroughRegion(const FitImage& fits) {
  std::vector<char> visited(fits.pixels.size(), 0);
  std::vector<int> waiting;
  int largest = 0;
  const auto visit = [&](int pixel) {
    if (visited[pixel] || fits.pixels[pixel] != PixelFit::kSeenThrough) return;
    visited[pixel] = 1;
    const int row = pixel / fits.width, column = pixel % fits.width;
    if (IsRendered(fits, row - 1, column) && IsRendered(fits, row + 1, column) &&
        IsRendered(fits, row, column - 1) && IsRendered(fits, row, column + 1))
      waiting.push_back(pixel);
  };
  for (int seed = 0; seed < static_cast<int>(fits.pixels.size()); ++seed) {
    int size = 0;
    visit(seed);
    while (!waiting.empty()) {
      const int pixel = waiting.back();
      waiting.pop_back();
      ++size;
      const int column = pixel % fits.width;
      if (column > 0) visit(pixel - 1);
      if (column + 1 < fits.width) visit(pixel + 1);
      if (pixel >= fits.width) visit(pixel - fits.width);
      if (pixel + fits.width < static_cast<int>(fits.pixels.size())) visit(pixel + fits.width);
    }
    largest = std::max(largest, size);
  }
  return largest;
}

}  // namespace rimod
