#include "rimod/single_correspondence.h"

#include <cmath>

namespace rimod {

std::optional<Eigen::Isometry3d> PoseFromCorrespondence(const Feature& scene, const Feature& model,
                                                        const Eigen::Vector3d& model_line_of_sight,
                                                        double max_vertical_cosine,
                                                        double min_normal_cosine) {
  const Eigen::Vector3d n_scene = scene.normal.cast<double>();
  const Eigen::Vector3d n_model = model.normal.cast<double>();
  const bool scene_vertical = std::abs(n_scene.z()) > max_vertical_cosine;
  const bool model_vertical = std::abs(n_model.z()) > max_vertical_cosine;
  if (scene_vertical != model_vertical) return std::nullopt;
  const Eigen::Vector3d scene_heading = scene_vertical ? scene.position.cast<double>() : n_scene;
  const Eigen::Vector3d model_heading = model_vertical ? model_line_of_sight : n_model;
  const double yaw = std::atan2(scene_heading.y(), scene_heading.x()) -
                     std::atan2(model_heading.y(), model_heading.x());
  Eigen::Isometry3d T_sensor_object = Eigen::Isometry3d::Identity();
  T_sensor_object.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  if ((T_sensor_object.linear() * n_model).dot(n_scene) < min_normal_cosine) return std::nullopt;
  T_sensor_object.translation() =
      scene.position.cast<double>() - T_sensor_object.linear() * model.position.cast<double>();
  return T_sensor_object;
}

}  // namespace rimod
