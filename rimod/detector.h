#pragma once

#include <optional>

#include "rimod/candidate_choice.h"
#include "rimod/default_method.h"
#include "rimod/detection.h"
#include "rimod/execution.h"
#include "rimod/feature_extraction.h"
#include "rimod/features.h"
#include "rimod/model_database.h"
#include "rimod/params.h"
#include "rimod/range_image.h"
#include "rimod/scan.h"

namespace rimod {

// The pipeline of the paper's section III as three steps, each a process of its own on the bus:
// scan -> range image (ComputeRangeImage), range image -> features (ExtractFeatures,
// feature_extraction.h), both
// -> detections (DetectObjects). docs/algorithm.md leads through it.
//
// Stage names that Execution hears: range_image, interest_points, descriptors, matching,
// hypotheses, scoring, collisions, validation; other methods may add further ones.

// Stage range_image.
RangeImage ComputeRangeImage(const Scan& scan, const PipelineParams& params,
                             const Execution& execution);

// Finds the database's objects in a scan given as range image and features. Throws
// std::invalid_argument for features of another kind than the parameters give and for a database
// prepared for another method. earlier: see FindByEvidence() (default_method.h).
DetectionResult DetectObjects(const RangeImage& image, const FeatureSet& features,
                              const ModelDatabase& database, const PipelineParams& params,
                              const Execution& execution,
                              std::optional<EarlierLook>* earlier = nullptr);

// DetectObjects of the default method before its last step, which is ChooseDetections
// (candidate_choice.h): for matchers that share the models. Throws as DetectObjects, also when the
// parameters choose another method.
JudgedScan JudgeObjects(const RangeImage& image, const FeatureSet& features,
                        const ModelDatabase& database, const PipelineParams& params,
                        const Execution& execution, std::optional<EarlierLook>* earlier = nullptr);

}  // namespace rimod
