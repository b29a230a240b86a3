#include "rimod/object_model.h"

#include <algorithm>
#include <stdexcept>

namespace rimod {
namespace {

void Require(bool condition, const std::string& complaint) {
  if (!condition) throw std::invalid_argument("object model: " + complaint);
}

constexpr double kFarthest = 1000.0;  // m; no object is larger, and grids over it stay countable

template <typename Vector>
bool IsNear(const Vector& v) {
  return v.allFinite() && v.cwiseAbs().maxCoeff() <= kFarthest;
}

bool AllNear(const std::vector<Eigen::Vector3f>& list) {
  return std::all_of(list.begin(), list.end(), IsNear<Eigen::Vector3f>);
}

void ValidateView(const ModelView& view, int descriptor_size) {
  Require(IsNear(view.viewpoint), "a viewpoint is not finite or absurdly far away");
  Require(AllNear(view.validation_points) && AllNear(view.validation_normals) &&
              AllNear(view.outside_points),
          "a validation or outside point is not finite or absurdly far away");
  Require(view.validation_points.size() == view.validation_normals.size(),
          "validation points and normals differ in number");
  for (const Feature& feature : view.features) {
    Require(IsNear(feature.position) && IsNear(feature.normal),
            "a feature's position or normal is not finite or absurdly far away");
    Require(static_cast<int>(feature.descriptor.size()) == descriptor_size,
            "a descriptor has " + std::to_string(feature.descriptor.size()) + " values, not " +
                std::to_string(descriptor_size));
  }
}

}  // namespace

bool IsValidModelName(const std::string& name) {
  constexpr std::size_t kMaxLength = 64;
  if (name.empty() || name.size() > kMaxLength || name.front() == '.') return false;
  return std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  });
}

void ValidateModel(const ObjectModel& model) {
  Require(IsValidModelName(model.name), "unusable name");
  Require(IsNear(model.box_min) && IsNear(model.box_max), "box is not finite or absurdly large");
  Require((model.box_min.array() <= model.box_max.array()).all(), "box with min above max");
  Require(model.point_spacing > 0.0 && model.point_spacing < 1.0, "point spacing out of 0 .. 1 m");
  Require(!model.points.empty(), "no points");
  Require(model.points.size() == model.normals.size(), "points and normals differ in number");
  Require(AllNear(model.points) && AllNear(model.normals),
          "a point or normal is not finite or absurdly far away");
  for (const ModelView& view : model.views) ValidateView(view, model.descriptor_size);
}

}  // namespace rimod
