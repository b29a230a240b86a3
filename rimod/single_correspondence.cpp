#include "rimod/single_correspondence.h"

#include <algorithm>
#include <cmath>

namespace rimod {

std::optional<Eigen::Isometry3d> PoseFromCorrespondence(const OrientedPoint& scene,
                                                        const OrientedPoint& model,
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

std::optional<Eigen::Isometry3d> TiltedToNormal(const Eigen::Isometry3d& T_sensor_object,
                                                const OrientedPoint& scene,
                                                const OrientedPoint& model, double min_angle,
                                                double max_angle) {
  const Eigen::Vector3d wanted = scene.normal.cast<double>();
  const Eigen::Vector3d normal = T_sensor_object.linear() * model.normal.cast<double>();
  const double angle = std::acos(std::clamp(normal.dot(wanted), -1.0, 1.0));
  if (!(angle >= min_angle && angle <= max_angle)) return std::nullopt;
  Eigen::Isometry3d tilted = T_sensor_object;
  tilted.linear() = Eigen::Quaterniond::FromTwoVectors(normal, wanted) * T_sensor_object.linear();
  tilted.translation() =
      scene.position.cast<double>() - tilted.linear() * model.position.cast<double>();
  return tilted;
}

}  // namespace rimod
