#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "rimod/features.h"

namespace rimod {

// The pose T_sensor_object of an upright object that lays a model's feature onto one of the scene:
// the normal's heading and the world's up fix the rotation, the positions the translation. The
// patch's frame (paper, section III-A) holds all of it; the paper uses three positions instead.
// Nothing when the normals rise too differently (min_normal_cosine between them after the turn).
// Where the scene's normal is steeper than max_vertical_cosine its heading is that of the line of
// sight, as in the patch's frame; model_line_of_sight is that of the model's view, object frame.
std::optional<Eigen::Isometry3d> PoseFromCorrespondence(const OrientedPoint& scene,
                                                        const OrientedPoint& model,
                                                        const Eigen::Vector3d& model_line_of_sight,
                                                        double max_vertical_cosine,
                                                        double min_normal_cosine);

// The pose turned further about the feature, the shortest way, until the normals agree: for objects
// that lean. Nothing when they are less than min_angle or more than max_angle (rad) apart.
std::optional<Eigen::Isometry3d> TiltedToNormal(const Eigen::Isometry3d& T_sensor_object,
                                                const OrientedPoint& scene,
                                                const OrientedPoint& model, double min_angle,
                                                double max_angle);

}  // namespace rimod
