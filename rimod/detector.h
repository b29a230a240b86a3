#pragma once

#include <memory>
#include <vector>

#include "rimod/detection.h"
#include "rimod/execution.h"
#include "rimod/features.h"
#include "rimod/object_model.h"
#include "rimod/params.h"
#include "rimod/range_image.h"
#include "rimod/scan.h"

namespace rimod {

// The pipeline of the paper's section III as three steps, each a process of its own on the bus:
// scan -> range image and features -> detections. docs/algorithm.md leads through it.

// Stage names that Execution hears: range_image, interest_points, descriptors, matching, hypotheses,
// scoring, collisions, validation; other methods may add further ones.

// Stage range_image.
RangeImage ComputeRangeImage(const Scan& scan, const PipelineParams& params,
                             const Execution& execution);

// Stages interest_points and descriptors.
FeatureSet ExtractFeatures(const RangeImage& image, const PipelineParams& params,
                           const Execution& execution);

// Features and validation points of a model whose surface (name, box, points, normals,
// point_spacing) is given: renders its virtual views and extracts them (sections III-A, III-C).
void ComputeModelViews(const PipelineParams& params, const Execution& execution,
                       ObjectModel* model);

// True when the model's features were extracted with these parameters.
bool ModelMatchesParams(const ObjectModel& model, const PipelineParams& params);

// The models that are looked for, with their search index. Immutable; order of the given models does
// not matter. Models of other parameters get their views computed anew. Throws std::invalid_argument
// for an invalid model or two of one name.
class ModelDatabase {
 public:
  ModelDatabase(std::vector<ObjectModel> models, const PipelineParams& params,
                const Execution& execution);
  ~ModelDatabase();
  ModelDatabase(ModelDatabase&&) noexcept;
  ModelDatabase& operator=(ModelDatabase&&) noexcept;

  const std::vector<ObjectModel>& models() const;

  struct Index;
  const Index& index() const { return *index_; }

 private:
  std::unique_ptr<Index> index_;
};

// Finds the database's objects in a scan given as range image and features. Features of another kind
// than the database's throw std::invalid_argument.
DetectionResult DetectObjects(const RangeImage& image, const FeatureSet& features,
                              const ModelDatabase& database, const PipelineParams& params,
                              const Execution& execution);

}  // namespace rimod
