#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rimod/execution.h"
#include "rimod/features.h"
#include "rimod/interest_points.h"
#include "rimod/object_model.h"
#include "rimod/params.h"
#include "rimod/range_image.h"

namespace rimod {

// Of the features that these parameters give: FeatureSet's descriptor_kind and descriptor_size.
std::string DescriptorKind(const PipelineParams& params);
int DescriptorSize(const PipelineParams& params);

// The features of a range image: interest points with descriptors, strongest first (paper, section
// III-A). Stages interest_points and descriptors. Points without a normal are left out.
FeatureSet ExtractFeatures(const RangeImage& image, const PipelineParams& params,
                           const Execution& execution);

// The second step of it: of these interest points. Stage descriptors.
FeatureSet DescribeFeatures(const RangeImage& image, const std::vector<PixelIndex>& interest_points,
                            const PipelineParams& params, const Execution& execution);

// The surroundings of interest points, each on its own: nothing where there is no normal. They
// depend on the points within DescriptorReach() of the interest point's only.
using DescribedPoints = std::vector<std::optional<Feature>>;
DescribedPoints DescribePoints(const RangeImage& image,
                               const std::vector<PixelIndex>& interest_points,
                               const PipelineParams& params, const Execution& execution);
// m, of a measured pixel.
double DescriptorReach(const RangeImage& image, const PixelIndex& pixel,
                       const PipelineParams& params);
// Of what these parameters describe, without what has no normal.
FeatureSet ToFeatureSet(DescribedPoints points, const PipelineParams& params);

// Features and validation points of a model whose surface (name, box, points, normals,
// point_spacing) is given: renders its virtual views and extracts them (sections III-A, III-C).
void ComputeModelViews(const PipelineParams& params, const Execution& execution,
                       ObjectModel* model);

// True when the model's features were extracted in the way that these parameters give.
bool ModelMatchesParams(const ObjectModel& model, const PipelineParams& params);

}  // namespace rimod
