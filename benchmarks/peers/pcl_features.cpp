#include "benchmarks/peers/pcl_features.h"

#include <pcl/features/normal_3d_omp.h>
#include <pcl/features/shot_omp.h>
#include <pcl/filters/uniform_sampling.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/peers/peer.h"

namespace rimod::peers {
namespace {

using Normals = pcl::PointCloud<pcl::Normal>;

Cloud::Ptr Sampled(const Cloud::ConstPtr& cloud, double spacing) {
  pcl::UniformSampling<pcl::PointXYZ> sampling;
  sampling.setInputCloud(cloud);
  sampling.setRadiusSearch(spacing);
  Cloud::Ptr sampled(new Cloud);
  sampling.filter(*sampled);
  return sampled;
}

pcl::ReferenceFrame FrameOf(const pcl::SHOT352& shot) {
  pcl::ReferenceFrame frame;
  for (int i = 0; i < 3; ++i) {
    frame.x_axis[i] = shot.rf[i];
    frame.y_axis[i] = shot.rf[3 + i];
    frame.z_axis[i] = shot.rf[6 + i];
  }
  return frame;
}

// Adds the descriptors of a surface with normals to what is described already.
void Describe(const Cloud::Ptr& surface, const Normals::Ptr& normals, double keypoint_spacing,
              const ShotSettings& settings, int num_threads, Described* described) {
  const Cloud::Ptr keypoints = Sampled(surface, keypoint_spacing);
  pcl::SHOTEstimationOMP<pcl::PointXYZ, pcl::Normal, pcl::SHOT352> shot(
      static_cast<unsigned>(num_threads));
  shot.setRadiusSearch(settings.shot_radius);
  shot.setInputCloud(keypoints);
  shot.setInputNormals(normals);
  shot.setSearchSurface(surface);
  pcl::PointCloud<pcl::SHOT352> all;
  shot.compute(all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!std::isfinite(all[i].descriptor[0]) || !std::isfinite(all[i].rf[0])) continue;
    described->keypoints->push_back((*keypoints)[i]);
    described->descriptors->push_back(all[i]);
    described->frames->push_back(FrameOf(all[i]));
  }
  *described->surface += *surface;
}

}  // namespace

Cloud::Ptr CloudOf(const std::vector<Eigen::Vector3f>& points) {
  Cloud::Ptr cloud(new Cloud);
  for (const Eigen::Vector3f& p : points) cloud->push_back({p.x(), p.y(), p.z()});
  return cloud;
}

Described DescribePoints(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& eye,
                         double keypoint_spacing, const ShotSettings& settings, int num_threads) {
  const Cloud::Ptr sampled = Sampled(CloudOf(points), settings.surface_spacing);
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(
      static_cast<unsigned>(num_threads));
  estimation.setInputCloud(sampled);
  estimation.setRadiusSearch(settings.normal_radius);
  estimation.setViewPoint(eye.x(), eye.y(), eye.z());
  Normals all;
  estimation.compute(all);
  const Cloud::Ptr surface(new Cloud);
  const Normals::Ptr normals(new Normals);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!std::isfinite(all[i].normal_x)) continue;
    surface->push_back((*sampled)[i]);
    normals->push_back(all[i]);
  }
  Described described;
  Describe(surface, normals, keypoint_spacing, settings, num_threads, &described);
  return described;
}

Described DescribeModel(const ObjectModel& model, const ShotSettings& settings, int num_threads) {
  Described all;
  if (settings.views == 0) {
    const Normals::Ptr normals(new Normals);
    for (const Eigen::Vector3f& n : model.normals)
      normals->push_back(pcl::Normal(n.x(), n.y(), n.z()));
    Describe(CloudOf(model.points), normals, settings.model_keypoints, settings, num_threads, &all);
  }
  for (int view = 0; view < settings.views; ++view) {
    const double azimuth = 2.0 * M_PI * view / settings.views;
    const Eigen::Vector3d eye(settings.view_distance * std::cos(azimuth),
                              settings.view_distance * std::sin(azimuth), settings.view_height);
    std::vector<Eigen::Vector3f> seen;
    for (const int i : VisiblePoints(model, eye))
      seen.push_back(model.points[static_cast<std::size_t>(i)]);
    if (seen.empty()) continue;
    const Described one =
        DescribePoints(seen, eye.cast<float>(), settings.model_keypoints, settings, num_threads);
    *all.surface += *one.surface;
    *all.keypoints += *one.keypoints;
    *all.descriptors += *one.descriptors;
    *all.frames += *one.frames;
  }
  return all;
}

}  // namespace rimod::peers
