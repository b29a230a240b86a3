#pragma once

#include <optional>
#include <vector>

#include "rimod/default_method.h"
#include "rimod/detection.h"
#include "rimod/execution.h"
#include "rimod/feature_extraction.h"
#include "rimod/features.h"
#include "rimod/model_database.h"
#include "rimod/params.h"
#include "rimod/range_image.h"
#include "rimod/sweep.h"

namespace rimod {

// Looks at sweeps that still go on, one after the other: each works on what the sweep has grown by
// since the look before. Everything is new in another sweep, and where the sensor's pose, the
// resolution or the axis of a pinhole image (the middle of what was seen) have changed since then.
// A look that is broken off (an Execution may throw) leaves all as it was.

// The features of growing scans: surroundings in which nothing has changed keep their description.
class GrowingExtractor {
 public:
  explicit GrowingExtractor(const PipelineParams& params) : params_(params) {}

  // Exactly what ExtractFeatures() gives. Its stages.
  FeatureSet Look(Time sweep_begin, const RangeImage& image, const Execution& execution);
  // Gives the memory free that the last look's sweep takes.
  void Forget() { before_.reset(); }

 private:
  struct Described {
    Time sweep_begin{0};
    RangeImage image;
    std::vector<PixelIndex> pixels;
    DescribedPoints points;
  };

  PipelineParams params_;
  std::optional<Described> before_;
};

// The objects in growing scans, by the default method; the paper's looks at everything anew.
class GrowingDetector {
 public:
  // Refers to the database.
  GrowingDetector(const ModelDatabase& database, const PipelineParams& params)
      : database_(database), params_(params) {}

  // About what DetectObjects() gives, see FindByEvidence(). Throws as that does.
  DetectionResult Look(Time sweep_begin, const RangeImage& image, const FeatureSet& features,
                       const Execution& execution);
  // Gives the memory free that the last look's sweep takes.
  void Forget() { before_.reset(); }

 private:
  const ModelDatabase& database_;
  PipelineParams params_;
  Time sweep_begin_{0};
  std::optional<EarlierLook> before_;
};

}  // namespace rimod
