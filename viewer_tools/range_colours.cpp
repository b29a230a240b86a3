#include "viewer_tools/range_colours.h"

#include <algorithm>
#include <cmath>

namespace rimod {

double RangeSpan::Share(double range) const {
  return std::log(range / near) / std::log(far / near);
}

RangeSpan SpanOf(std::vector<float> ranges, double left_out_near, double left_out_far) {
  if (ranges.empty()) return {};
  std::sort(ranges.begin(), ranges.end());
  const std::size_t last = ranges.size() - 1;
  const auto at = [&](double share) {
    return std::min(static_cast<std::size_t>(share * static_cast<double>(ranges.size())), last);
  };
  const double near = ranges[at(left_out_near)];
  return {near, std::max<double>(ranges[last - at(left_out_far)], near * 1.1)};
}

Colour PixelColour(const RangeImage& image, int row, int column, const RangeSpan& span, int x,
                   int y) {
  if (!image.grid().Contains(row, column)) return NeverObservedColour(x, y);
  switch (image.pixel(row, column)) {
    case Pixel::kMeasured:
      return RangeColour(span.Share(image.range(row, column)));
    case Pixel::kNoReturn:
      return NoReturnColour();
    case Pixel::kNeverObserved:
      break;
  }
  return NeverObservedColour(x, y);
}

}  // namespace rimod
