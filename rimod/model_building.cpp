#include "rimod/model_building.h"

#include <algorithm>
#include <stdexcept>

#include "rimod/detector.h"
#include "rimod/model_surface.h"

namespace rimod {
namespace {

constexpr std::size_t kMinPoints = 50;  // fewer describe no object

ObjectModel FinishModel(const std::string& class_name, const std::string& source, Surface surface,
                        const PipelineParams& params, const Execution& execution,
                        ObjectModel model) {
  if (surface.points.size() < kMinPoints) {
    throw std::invalid_argument("only " + std::to_string(surface.points.size()) +
                                " surface points of " + class_name + ", at least " +
                                std::to_string(kMinPoints) + " are needed");
  }
  model.name = class_name;
  model.source = source;
  model.point_spacing = surface.point_spacing;
  model.points = std::move(surface.points);
  model.normals = std::move(surface.normals);
  ValidateModel(model);
  ComputeModelViews(params, execution, &model);
  return model;
}

void SetBoxFromSurface(const Surface& surface, ObjectModel* model) {
  if (surface.points.empty()) return;
  Eigen::Vector3f low = surface.points.front(), high = low;
  for (const Eigen::Vector3f& point : surface.points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  model->box_min = low.cast<double>();
  model->box_max = high.cast<double>();
}

}  // namespace

ObjectModel BuildModel(const Recording& recording, const PipelineParams& params,
                       const Execution& execution) {
  ObjectModel model;
  model.box_min = recording.box_min;
  model.box_max = recording.box_max;
  return FinishModel(recording.class_name, std::to_string(recording.scans.size()) + " scans",
                     SurfaceOfRecording(recording, params.model_surface, execution), params,
                     execution, model);
}

ObjectModel BuildModelFromPoints(const std::string& class_name,
                                 const std::vector<Eigen::Vector3f>& points,
                                 const PipelineParams& params, const Execution& execution) {
  Surface surface = SurfaceOfPoints(points, params.model_surface);
  ObjectModel model;
  SetBoxFromSurface(surface, &model);
  return FinishModel(class_name, "cloud", std::move(surface), params, execution, model);
}

ObjectModel BuildModelFromMesh(const std::string& class_name, const Mesh& mesh,
                               const PipelineParams& params, const Execution& execution) {
  Surface surface = SurfaceOfMesh(mesh, params.model_surface);
  ObjectModel model;
  SetBoxFromSurface(surface, &model);
  return FinishModel(class_name, "mesh", std::move(surface), params, execution, model);
}

}  // namespace rimod
