// The Point Cloud Library's recognition pipeline: uniform sampling, SHOT, geometric consistency
// grouping, ICP, hypothesis verification.

#include <pcl/console/print.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/features/shot_omp.h>
#include <pcl/filters/uniform_sampling.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>
#include <pcl/recognition/cg/geometric_consistency.h>
#include <pcl/registration/icp.h>

#include <cstdlib>

#include "benchmarks/peers/peer.h"

namespace {

using rimod::ObjectModel;
using rimod::peers::Candidate;
using rimod::peers::Scene;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Descriptors = pcl::PointCloud<pcl::SHOT352>;

// Of those tried (docs/benchmarks.md) these found most.
constexpr double kSurfaceSpacing = 0.02;  // m
constexpr double kSceneKeypoints = 0.06;  // m, between
constexpr double kModelKeypoints = 0.05;  // m
constexpr double kNormalRadius = 0.07;    // m
constexpr double kShotRadius = 0.25;      // m
constexpr int kNearest = 3;               // correspondences of a scene's descriptor and a model
constexpr float kMaxDistanceSq = 0.35f;   // of descriptors
constexpr double kConsistency = 0.06;     // m
constexpr int kMinGroup = 3;
constexpr std::size_t kMaxRefined = 60;  // groups of a model
constexpr int kIcpIterations = 15;
constexpr double kIcpReach = 0.08;  // m

Cloud::Ptr CloudOf(const std::vector<Eigen::Vector3f>& points) {
  const Cloud::Ptr cloud(new Cloud);
  for (const Eigen::Vector3f& p : points) cloud->push_back({p.x(), p.y(), p.z()});
  return cloud;
}

Cloud::Ptr Sampled(const Cloud::ConstPtr& cloud, double spacing) {
  pcl::UniformSampling<pcl::PointXYZ> sampling;
  sampling.setInputCloud(cloud);
  sampling.setRadiusSearch(spacing);
  const Cloud::Ptr sampled(new Cloud);
  sampling.filter(*sampled);
  return sampled;
}

unsigned NumThreads() {
  const char* const text = std::getenv("PEER_THREADS");
  return text ? static_cast<unsigned>(std::atoi(text)) : 1u;
}

// Keypoints that have a descriptor, and the descriptors.
struct Described {
  Cloud::Ptr keypoints{new Cloud};
  Descriptors::Ptr descriptors{new Descriptors};
};

Described Describe(const Cloud::ConstPtr& surface, const Normals::ConstPtr& normals,
                   double spacing) {
  const Cloud::Ptr keypoints = Sampled(surface, spacing);
  pcl::SHOTEstimationOMP<pcl::PointXYZ, pcl::Normal, pcl::SHOT352> shot(NumThreads());
  shot.setRadiusSearch(kShotRadius);
  shot.setInputCloud(keypoints);
  shot.setInputNormals(normals);
  shot.setSearchSurface(surface);
  Descriptors all;
  shot.compute(all);
  Described described;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!std::isfinite(all[i].descriptor[0])) continue;
    described.keypoints->push_back((*keypoints)[i]);
    described.descriptors->push_back(all[i]);
  }
  return described;
}

// The points that have a normal, and the normals.
std::pair<Cloud::Ptr, Normals::Ptr> WithNormals(const Cloud::ConstPtr& points,
                                                const Eigen::Vector3f& eye) {
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(NumThreads());
  estimation.setInputCloud(points);
  estimation.setRadiusSearch(kNormalRadius);
  estimation.setViewPoint(eye.x(), eye.y(), eye.z());
  Normals all;
  estimation.compute(all);
  const Cloud::Ptr surface(new Cloud);
  const Normals::Ptr normals(new Normals);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!std::isfinite(all[i].normal_x)) continue;
    surface->push_back((*points)[i]);
    normals->push_back(all[i]);
  }
  return {surface, normals};
}

class Pipeline {
 public:
  void Learn(const std::vector<ObjectModel>& models) {
    for (const ObjectModel& model : models) {
      const Cloud::Ptr cloud = CloudOf(model.points);
      const Normals::Ptr normals(new Normals);
      for (const Eigen::Vector3f& n : model.normals)
        normals->push_back(pcl::Normal(n.x(), n.y(), n.z()));
      models_.push_back({&model, Describe(cloud, normals, kModelKeypoints), {}});
      models_.back().tree.setInputCloud(models_.back().described.descriptors);
    }
  }

  std::vector<Candidate> Find(const Scene& scene) {
    const Eigen::Vector3d eye = scene.scan.T_local_sensor.translation();
    const auto [surface, normals] =
        WithNormals(Sampled(CloudOf(scene.scan.points), kSurfaceSpacing), eye.cast<float>());
    const Described described = Describe(surface, normals, kSceneKeypoints);
    pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
    icp.setMaximumIterations(kIcpIterations);
    icp.setMaxCorrespondenceDistance(kIcpReach);
    icp.setInputTarget(surface);
    std::vector<Candidate> candidates;
    for (std::size_t m = 0; m < models_.size(); ++m) {
      for (const Eigen::Isometry3d& pose : Groups(models_[m], described))
        candidates.push_back({m, Refined(*models_[m].model, pose, eye, &icp), 0.0});
    }
    return candidates;
  }

 private:
  struct Model {
    const ObjectModel* model;
    Described described;
    pcl::KdTreeFLANN<pcl::SHOT352> tree;
  };

  static std::vector<Eigen::Isometry3d> Groups(const Model& model, const Described& scene) {
    const pcl::CorrespondencesPtr pairs(new pcl::Correspondences);
    std::vector<int> nearest(kNearest);
    std::vector<float> distances_sq(kNearest);
    for (std::size_t i = 0; i < scene.descriptors->size(); ++i) {
      const int found =
          model.tree.nearestKSearch((*scene.descriptors)[i], kNearest, nearest, distances_sq);
      for (int k = 0; k < found; ++k) {
        const auto j = static_cast<std::size_t>(k);
        if (distances_sq[j] < kMaxDistanceSq)
          pairs->emplace_back(nearest[j], static_cast<int>(i), distances_sq[j]);
      }
    }
    pcl::GeometricConsistencyGrouping<pcl::PointXYZ, pcl::PointXYZ> grouping;
    grouping.setGCSize(kConsistency);
    grouping.setGCThreshold(kMinGroup);
    grouping.setInputCloud(model.described.keypoints);
    grouping.setSceneCloud(scene.keypoints);
    grouping.setModelSceneCorrespondences(pairs);
    std::vector<Eigen::Matrix4f, Eigen::aligned_allocator<Eigen::Matrix4f>> transforms;
    std::vector<pcl::Correspondences> groups;
    grouping.recognize(transforms, groups);
    std::vector<std::size_t> order(transforms.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return groups[a].size() > groups[b].size();
    });
    std::vector<Eigen::Isometry3d> poses;
    for (const std::size_t i : order) {
      Eigen::Isometry3d T;
      T.matrix() = transforms[i].cast<double>();
      if (rimod::peers::IsUpright(T) && poses.size() < kMaxRefined) poses.push_back(T);
    }
    return poses;
  }

  static Eigen::Isometry3d Refined(const ObjectModel& model, const Eigen::Isometry3d& T_scan_model,
                                   const Eigen::Vector3d& eye,
                                   pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ>* icp) {
    constexpr std::size_t kPoints = 400;
    const std::vector<int> facing = rimod::peers::FacingPoints(model, T_scan_model, eye);
    const std::size_t step = std::max<std::size_t>(1, facing.size() / kPoints);
    const Cloud::Ptr cloud(new Cloud);
    for (std::size_t i = 0; i < facing.size(); i += step) {
      const Eigen::Vector3f& p = model.points[static_cast<std::size_t>(facing[i])];
      cloud->push_back({p.x(), p.y(), p.z()});
    }
    if (cloud->size() < 20) return T_scan_model;
    icp->setInputSource(cloud);
    Cloud aligned;
    icp->align(aligned, T_scan_model.matrix().cast<float>());
    const Eigen::Matrix4d m = icp->getFinalTransformation().cast<double>();
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = m.block<3, 1>(0, 3);
    T.linear() = Eigen::Quaterniond(Eigen::Matrix3d(m.block<3, 3>(0, 0))).normalized().matrix();
    return T.matrix().allFinite() && rimod::peers::IsUpright(T) ? T : T_scan_model;
  }

  std::vector<Model> models_;
};

}  // namespace

int main(int argc, char** argv) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // else a line for each failed group
  Pipeline pipeline;
  return rimod::peers::RunPeer(
      argc, argv,
      {[&](const std::vector<ObjectModel>& models) { pipeline.Learn(models); },
       [&](const Scene& scene) { return pipeline.Find(scene); }});
}
