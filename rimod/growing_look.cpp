#include "rimod/growing_look.h"

#include <map>
#include <utility>

#include "rimod/detector.h"
#include "rimod/image_change.h"

namespace rimod {

FeatureSet GrowingExtractor::Look(Time sweep_begin, const RangeImage& image,
                                  const Execution& execution) {
  Described now{sweep_begin, image, {}, {}};
  {
    const StageScope stage(execution, "interest_points");
    now.pixels = FindInterestPoints(image, params_.interest_points, execution);
  }
  const StageScope stage(execution, "descriptors");
  const bool same_sweep = before_ && before_->sweep_begin == sweep_begin;
  const ImageChange change = same_sweep ? ImageChange(before_->image, image) : ImageChange();
  std::map<std::pair<int, int>, std::size_t> known;  // by row and column of this image
  if (!change.everything()) {
    for (std::size_t i = 0; i < before_->pixels.size(); ++i) {
      known.emplace(std::pair(before_->pixels[i].row + change.row_shift(),
                              before_->pixels[i].column + change.column_shift()),
                    i);
    }
  }
  now.points.resize(now.pixels.size());
  std::vector<std::size_t> changed;
  std::vector<PixelIndex> changed_pixels;
  for (std::size_t i = 0; i < now.pixels.size(); ++i) {
    const PixelIndex& pixel = now.pixels[i];
    const auto at = known.find(std::pair(pixel.row, pixel.column));
    const float reach = static_cast<float>(DescriptorReach(image, pixel, params_));
    if (at != known.end() && !change.Touches(image.point(pixel.row, pixel.column), reach)) {
      now.points[i] = before_->points[at->second];
    } else {
      changed.push_back(i);
      changed_pixels.push_back(pixel);
    }
  }
  DescribedPoints described = DescribePoints(image, changed_pixels, params_, execution);
  for (std::size_t i = 0; i < changed.size(); ++i) now.points[changed[i]] = std::move(described[i]);
  before_ = std::move(now);
  return ToFeatureSet(before_->points, params_);
}

DetectionResult GrowingDetector::Look(Time sweep_begin, const RangeImage& image,
                                      const FeatureSet& features, const Execution& execution) {
  if (sweep_begin == sweep_begin_)
    return DetectObjects(image, features, database_, params_, execution, &before_);
  std::optional<EarlierLook> first;
  DetectionResult result = DetectObjects(image, features, database_, params_, execution, &first);
  before_ = std::move(first);
  sweep_begin_ = sweep_begin;
  return result;
}

}  // namespace rimod
