#include "rimod/feature_extraction.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "rimod/interest_points.h"
#include "rimod/model_views.h"
#include "rimod/range_patch.h"
#include "rimod/spherical_spin.h"

namespace rimod {
namespace {

void MoveToObjectFrame(const Eigen::Isometry3d& T_object_sensor, Feature* feature) {
  feature->position = (T_object_sensor * feature->position.cast<double>()).cast<float>();
  feature->normal = (T_object_sensor.linear() * feature->normal.cast<double>()).cast<float>();
}

// False for the ground that the object stands on in its views.
bool BelongsToObject(const ObjectModel& model, const PipelineParams& params,
                     const Feature& feature) {
  if (params.model_views.ground_margin <= 0.0) return true;
  const Eigen::Vector3d p = feature.position.cast<double>();
  const double lowest = model.box_min.z() + params.model_surface.ground_clearance;
  return p.z() > lowest;
}

ModelView ComputeView(const ObjectModel& model, const Eigen::Vector3d& viewpoint,
                      const PipelineParams& params) {
  const RangeImage image =
      RenderView(model, viewpoint, params.range_image.resolution, params.model_views.ground_margin);
  ModelView view;
  view.viewpoint = viewpoint;
  for (Feature& feature : ExtractFeatures(image, params, Execution{}).features) {
    MoveToObjectFrame(image.T_local_sensor(), &feature);
    if (BelongsToObject(model, params, feature)) view.features.push_back(std::move(feature));
  }
  SampleViewPoints(model, params.range_image.resolution, params.model_views, &view);
  return view;
}

// What a model's features depend on besides its surface.
std::string ModelFeatureKind(const PipelineParams& params) {
  std::ostringstream kind;
  kind << DescriptorKind(params) << "; " << params.interest_points.Kind() << "; "
       << params.model_views.Kind() << "; pixel " << params.range_image.resolution;
  return kind.str();
}

}  // namespace

std::string DescriptorKind(const PipelineParams& params) {
  return params.descriptor == DescriptorType::kSphericalSpin ? params.spherical_spin.Kind()
                                                             : params.range_patch.Kind();
}

int DescriptorSize(const PipelineParams& params) {
  return params.descriptor == DescriptorType::kSphericalSpin
             ? params.spherical_spin.DescriptorSize()
             : params.range_patch.resolution * params.range_patch.resolution;
}

FeatureSet ExtractFeatures(const RangeImage& image, const PipelineParams& params,
                           const Execution& execution) {
  std::vector<PixelIndex> interest_points;
  {
    const StageScope stage(execution, "interest_points");
    interest_points = FindInterestPoints(image, params.interest_points, execution);
  }
  return DescribeFeatures(image, interest_points, params, execution);
}

FeatureSet DescribeFeatures(const RangeImage& image, const std::vector<PixelIndex>& interest_points,
                            const PipelineParams& params, const Execution& execution) {
  const StageScope stage(execution, "descriptors");
  return ToFeatureSet(DescribePoints(image, interest_points, params, execution), params);
}

DescribedPoints DescribePoints(const RangeImage& image,
                               const std::vector<PixelIndex>& interest_points,
                               const PipelineParams& params, const Execution& execution) {
  DescribedPoints described(interest_points.size());
  if (params.descriptor == DescriptorType::kSphericalSpin) {
    const SphericalSpinDescriber describe(params.spherical_spin);
    execution.parallel_for(interest_points.size(), [&](std::size_t i) {
      described[i] = describe(image, interest_points[i]);
    });
  } else {
    execution.parallel_for(interest_points.size(), [&](std::size_t i) {
      described[i] = DescribePatch(image, interest_points[i], params.range_patch);
    });
  }
  return described;
}

double DescriptorReach(const RangeImage& image, const PixelIndex& pixel,
                       const PipelineParams& params) {
  const double spacing =
      PixelAngle(image.grid(), pixel.row, pixel.column) * image.range(pixel.row, pixel.column);
  return params.descriptor == DescriptorType::kSphericalSpin
             ? ReachOf(params.spherical_spin, spacing)
             : ReachOf(params.range_patch, spacing);
}

FeatureSet ToFeatureSet(DescribedPoints points, const PipelineParams& params) {
  FeatureSet set;
  set.descriptor_kind = DescriptorKind(params);
  set.descriptor_size = DescriptorSize(params);
  for (std::optional<Feature>& feature : points)
    if (feature) set.features.push_back(std::move(*feature));
  return set;
}

void ComputeModelViews(const PipelineParams& params, const Execution& execution,
                       ObjectModel* model) {
  const std::vector<Eigen::Vector3d> viewpoints = Viewpoints(*model, params.model_views);
  std::vector<ModelView> views(viewpoints.size());
  execution.parallel_for(viewpoints.size(), [&](std::size_t i) {
    views[i] = ComputeView(*model, viewpoints[i], params);
  });
  model->views = std::move(views);
  model->descriptor_kind = ModelFeatureKind(params);
  model->descriptor_size = DescriptorSize(params);
}

bool ModelMatchesParams(const ObjectModel& model, const PipelineParams& params) {
  // The size too: a model from elsewhere may claim a kind that its descriptors are not of.
  return model.descriptor_kind == ModelFeatureKind(params) &&
         model.descriptor_size == DescriptorSize(params);
}

}  // namespace rimod
