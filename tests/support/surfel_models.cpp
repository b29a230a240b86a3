#include "tests/support/surfel_models.h"

#include <algorithm>
#include <cmath>

namespace rimod {
namespace {

ObjectModel Named(const std::string& name, double spacing, const Eigen::Vector3d& size) {
  ObjectModel model;
  model.name = name;
  model.point_spacing = spacing;
  model.box_min = Eigen::Vector3d(-0.5 * size.x(), -0.5 * size.y(), 0.0);
  model.box_max = Eigen::Vector3d(0.5 * size.x(), 0.5 * size.y(), size.z());
  return model;
}

// Points at the middles of even cells of the parallelogram around centre with these whole sides.
void AddFace(const Eigen::Vector3d& centre, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
             const Eigen::Vector3d& normal, ObjectModel* model) {
  const int nu = std::max(1, static_cast<int>(std::lround(u.norm() / model->point_spacing)));
  const int nv = std::max(1, static_cast<int>(std::lround(v.norm() / model->point_spacing)));
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      const Eigen::Vector3d p = centre + ((i + 0.5) / nu - 0.5) * u + ((j + 0.5) / nv - 0.5) * v;
      model->points.push_back(p.cast<float>());
      model->normals.push_back(normal.cast<float>());
    }
  }
}

}  // namespace

ObjectModel PlateModel(const std::string& name, double side, double spacing) {
  ObjectModel model = Named(name, spacing, {0.0, side, side});
  AddFace({0.0, 0.0, 0.5 * side}, {0.0, side, 0.0}, {0.0, 0.0, side}, Eigen::Vector3d::UnitX(),
          &model);
  return model;
}

ObjectModel SphereModel(const std::string& name, double radius, double spacing) {
  ObjectModel model = Named(name, spacing, Eigen::Vector3d::Constant(2.0 * radius));
  const int rings = static_cast<int>(std::ceil(M_PI * radius / spacing));
  for (int i = 0; i < rings; ++i) {
    const double polar = M_PI * (i + 0.5) / rings;
    const int count = static_cast<int>(std::ceil(2.0 * M_PI * radius * std::sin(polar) / spacing));
    for (int j = 0; j < count; ++j) {
      const double azimuth = 2.0 * M_PI * j / count;
      const Eigen::Vector3d normal(std::sin(polar) * std::cos(azimuth),
                                   std::sin(polar) * std::sin(azimuth), std::cos(polar));
      model.points.push_back((radius * normal + Eigen::Vector3d(0, 0, radius)).cast<float>());
      model.normals.push_back(normal.cast<float>());
    }
  }
  return model;
}

ObjectModel BoxModel(const std::string& name, const Eigen::Vector3d& size, double spacing) {
  ObjectModel model = Named(name, spacing, size);
  const Eigen::Vector3d middle(0.0, 0.0, 0.5 * size.z());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
    const int other = (axis + 1) % 3, third = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      AddFace(middle + side * 0.5 * size[axis] * unit, size[other] * Eigen::Vector3d::Unit(other),
              size[third] * Eigen::Vector3d::Unit(third), side * unit, &model);
    }
  }
  return model;
}

}  // namespace rimod
