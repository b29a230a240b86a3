#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>
#include <vector>

#include "rimod/object_model.h"

namespace rimod::peers {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

struct ShotSettings {
  double surface_spacing = 0.02;  // m, what normals and descriptors are computed from
  double scene_keypoints = 0.06;  // m, between
  double model_keypoints = 0.04;  // m
  double normal_radius = 0.06;    // m
  double shot_radius = 0.25;      // m
  int views = 8;                  // of a model, all round; 0: its whole surface at once
  double view_distance = 2.5;     // m
  double view_height = 1.1;       // m, of the eye
};

// Keypoints with their SHOT descriptors and these' reference frames, and what they were made from.
struct Described {
  Cloud::Ptr surface{new Cloud};
  Cloud::Ptr keypoints{new Cloud};
  pcl::PointCloud<pcl::SHOT352>::Ptr descriptors{new pcl::PointCloud<pcl::SHOT352>};
  pcl::PointCloud<pcl::ReferenceFrame>::Ptr frames{new pcl::PointCloud<pcl::ReferenceFrame>};
};

Cloud::Ptr CloudOf(const std::vector<Eigen::Vector3f>& points);

// Points seen from an eye: evenly sampled, with normals, keypoints every so many metres.
Described DescribePoints(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& eye,
                         double keypoint_spacing, const ShotSettings& settings, int num_threads);

// A model as it is seen from all round, all views' descriptors in one list; keypoints in its frame.
Described DescribeModel(const ObjectModel& model, const ShotSettings& settings, int num_threads);

}  // namespace rimod::peers
