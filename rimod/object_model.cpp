#include "rimod/object_model.h"

#include <algorithm>
#include <stdexcept>

namespace rimod {
namespace {

void Require(bool condition, const std::string& complaint) {
  if (!condition) throw std::invalid_argument("object model: " + complaint);
}

bool AllFinite(const std::vector<Eigen::Vector3f>& list) {
  return std::all_of(list.begin(), list.end(),
                     [](const Eigen::Vector3f& v) { return v.allFinite(); });
}

void ValidateView(const ModelView& view, int descriptor_size) {
  Require(view.viewpoint.allFinite(), "a viewpoint is not finite");
  Require(AllFinite(view.validation_points) && AllFinite(view.validation_normals) &&
              AllFinite(view.outside_points),
          "a validation or outside point is not finite");
  Require(view.validation_points.size() == view.validation_normals.size(),
          "validation points and normals differ in number");
  for (const Feature& feature : view.features) {
    Require(feature.position.allFinite() && feature.normal.allFinite(),
            "a feature's position or normal is not finite");
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
  Require(model.box_min.allFinite() && model.box_max.allFinite(), "box is not finite");
  Require((model.box_min.array() <= model.box_max.array()).all(), "box with min above max");
  Require(model.point_spacing > 0.0 && model.point_spacing < 1.0, "point spacing out of 0 .. 1 m");
  Require(!model.points.empty(), "no points");
  Require(model.points.size() == model.normals.size(), "points and normals differ in number");
  Require(AllFinite(model.points) && AllFinite(model.normals), "a point or normal is not finite");
  for (const ModelView& view : model.views) ValidateView(view, model.descriptor_size);
}

}  // namespace rimod
