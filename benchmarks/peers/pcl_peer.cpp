// The Point Cloud Library's recognition pipeline: uniform sampling, SHOT, correspondence grouping
// (geometric consistency or Hough voting), ICP, hypothesis verification.

#include <pcl/console/print.h>
#include <pcl/recognition/cg/geometric_consistency.h>
#include <pcl/recognition/cg/hough_3d.h>
#include <pcl/recognition/hv/hv_go.h>
#include <pcl/registration/icp.h>
#include <pcl/search/flann_search.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <pcl/search/impl/flann_search.hpp>

#include "benchmarks/peers/pcl_features.h"
#include "benchmarks/peers/peer.h"

namespace {

using rimod::ObjectModel;
using rimod::peers::Cloud;
using rimod::peers::Described;
using rimod::peers::ObjectPoints;
using rimod::peers::Proposal;

// Of those tried (docs/benchmarks.md) these found most.
struct Settings {
  rimod::peers::ShotSettings shot;
  int checks = 200;  // leaves of FLANN's four randomised kd-trees that are looked at; -1: all
  int nearest = 3;   // correspondences of a scene's descriptor and a model
  double max_distance_sq = 0.35;  // of descriptors
  double upright_pairs = 25;      // deg, correspondences whose frames give a greater lean; 0: kept
  bool hough = false;             // else geometric consistency
  double bin = 0.06;              // m, of consistency or of Hough's bins
  double min_votes = 3;
  std::size_t max_refined = 40;  // groups of a model
  int icp_iterations = 15;
  double icp_reach = 0.08;  // m
  bool verify = true;
  std::size_t max_verified = 5;  // poses of a model
  int verify_iterations = 300;
  double inlier_distance = 0.04;  // m, of verification
  double regularizer = 3.0;
  double clutter_regularizer = 5.0;
};

using DescriptorSearch = pcl::search::FlannSearch<pcl::SHOT352>;

struct Model {
  const ObjectModel* model = nullptr;
  Described described;
  std::shared_ptr<DescriptorSearch> search;
};

// What a correspondence's two reference frames make of the model's up.
double LeanOf(const pcl::ReferenceFrame& scene, const pcl::ReferenceFrame& model) {
  const double up = scene.x_axis[2] * model.x_axis[2] + scene.y_axis[2] * model.y_axis[2] +
                    scene.z_axis[2] * model.z_axis[2];
  return std::acos(std::clamp(up, -1.0, 1.0)) * 180.0 / M_PI;
}

class Pipeline : public rimod::peers::Peer {
 public:
  void AddOptions(CLI::App* app) override {
    Settings& s = settings_;
    app->add_option("--surface-spacing", s.shot.surface_spacing, "m");
    app->add_option("--scene-keypoints", s.shot.scene_keypoints, "m, between keypoints");
    app->add_option("--model-keypoints", s.shot.model_keypoints, "m");
    app->add_option("--normal-radius", s.shot.normal_radius, "m");
    app->add_option("--shot-radius", s.shot.shot_radius, "m");
    app->add_option("--views", s.shot.views, "Of a model; 0: its whole surface at once");
    app->add_option("--checks", s.checks, "Leaves of FLANN's kd-trees that are looked at");
    app->add_option("--nearest", s.nearest, "Correspondences of a descriptor and a model");
    app->add_option("--max-distance-sq", s.max_distance_sq, "Of descriptors");
    app->add_option("--upright-pairs", s.upright_pairs, "deg, most lean by the frames; 0: any");
    app->add_flag("--hough,!--consistency", s.hough, "Hough voting in place of consistency");
    app->add_option("--bin", s.bin, "m, of consistency or of Hough's bins");
    app->add_option("--min-votes", s.min_votes, "Correspondences of a group");
    app->add_option("--max-refined", s.max_refined, "Groups of a model that go to ICP");
    app->add_option("--icp-iterations", s.icp_iterations, "0: no ICP");
    app->add_option("--icp-reach", s.icp_reach, "m");
    app->add_flag("--verify,!--no-verify", s.verify, "Global hypothesis verification");
    app->add_option("--max-verified", s.max_verified, "Poses of a model that are verified");
    app->add_option("--verify-iterations", s.verify_iterations, "Of simulated annealing");
    app->add_option("--inlier-distance", s.inlier_distance, "m, of verification");
    app->add_option("--regularizer", s.regularizer, "Of verification: cost of what does not fit");
    app->add_option("--clutter-regularizer", s.clutter_regularizer, "Of verification");
  }

  void Learn(const std::vector<ObjectModel>& models, int num_threads,
             const rimod::Execution& execution) override {
    num_threads_ = num_threads;
    execution_ = execution;
    for (const ObjectModel& model : models) {
      models_.push_back({&model, DescribeModel(model, settings_.shot, num_threads), {}});
      Model& learnt = models_.back();
      if (learnt.described.descriptors->empty()) continue;
      constexpr unsigned kTrees = 4;
      learnt.search = std::make_shared<DescriptorSearch>(
          true, DescriptorSearch::FlannIndexCreatorPtr(
                    new DescriptorSearch::KdTreeMultiIndexCreator(kTrees)));
      learnt.search->setChecks(settings_.checks);
      learnt.search->setInputCloud(learnt.described.descriptors);
    }
  }

  std::vector<Proposal> Find(const ObjectPoints& scan) override {
    const Described scene =
        DescribePoints(scan.points, scan.eye.cast<float>(), settings_.shot.scene_keypoints,
                       settings_.shot, num_threads_);
    if (scene.descriptors->empty()) return {};
    const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
    tree->setInputCloud(scene.surface);
    std::vector<std::vector<Proposal>> of_model(models_.size());
    execution_.parallel_for(models_.size(), [&](std::size_t m) {
      of_model[m] = Groups(m, scene);
      for (Proposal& proposal : of_model[m]) Refine(scan.eye, scene.surface, tree, &proposal);
    });
    std::vector<Proposal> all;
    for (const auto& some : of_model) all.insert(all.end(), some.begin(), some.end());
    if (settings_.verify) Verify(scan.eye, scene.surface, &all);
    return all;
  }

 private:
  pcl::CorrespondencesPtr Correspondences(const Model& model, const Described& scene) const {
    const pcl::CorrespondencesPtr pairs(new pcl::Correspondences);
    pcl::Indices nearest(static_cast<std::size_t>(settings_.nearest));
    std::vector<float> distances_sq(nearest.size());
    for (std::size_t i = 0; i < scene.descriptors->size(); ++i) {
      const int found = model.search->nearestKSearch((*scene.descriptors)[i], settings_.nearest,
                                                     nearest, distances_sq);
      for (std::size_t k = 0; k < static_cast<std::size_t>(found); ++k) {
        if (distances_sq[k] > settings_.max_distance_sq) continue;
        const pcl::ReferenceFrame& frame =
            (*model.described.frames)[static_cast<std::size_t>(nearest[k])];
        if (settings_.upright_pairs > 0.0 &&
            LeanOf((*scene.frames)[i], frame) > settings_.upright_pairs)
          continue;
        pairs->emplace_back(nearest[k], static_cast<int>(i), distances_sq[k]);
      }
    }
    return pairs;
  }

  std::vector<Proposal> Groups(std::size_t index, const Described& scene) const {
    const Model& model = models_[index];
    if (!model.search) return {};
    std::vector<Eigen::Matrix4f, Eigen::aligned_allocator<Eigen::Matrix4f>> transforms;
    std::vector<pcl::Correspondences> groups;
    if (settings_.hough) {
      pcl::Hough3DGrouping<pcl::PointXYZ, pcl::PointXYZ> grouping;
      grouping.setHoughBinSize(settings_.bin);
      grouping.setHoughThreshold(settings_.min_votes);
      grouping.setUseInterpolation(true);
      grouping.setInputCloud(model.described.keypoints);  // forgets frames: they come after it
      grouping.setInputRf(model.described.frames);
      grouping.setSceneCloud(scene.keypoints);
      grouping.setSceneRf(scene.frames);
      grouping.setModelSceneCorrespondences(Correspondences(model, scene));
      grouping.recognize(transforms, groups);
    } else {
      pcl::GeometricConsistencyGrouping<pcl::PointXYZ, pcl::PointXYZ> grouping;
      grouping.setGCSize(settings_.bin);
      grouping.setGCThreshold(static_cast<int>(settings_.min_votes));
      grouping.setInputCloud(model.described.keypoints);
      grouping.setSceneCloud(scene.keypoints);
      grouping.setModelSceneCorrespondences(Correspondences(model, scene));
      grouping.recognize(transforms, groups);
    }
    std::vector<Proposal> proposals;
    for (std::size_t i = 0; i < transforms.size(); ++i) {
      const Eigen::Isometry3d T = rimod::peers::PoseOf(transforms[i].cast<double>());
      if (rimod::peers::IsUpright(T))
        proposals.push_back({index, T, static_cast<double>(groups[i].size())});
    }
    std::stable_sort(proposals.begin(), proposals.end(),
                     [](const Proposal& a, const Proposal& b) { return a.measure > b.measure; });
    if (proposals.size() > settings_.max_refined) proposals.resize(settings_.max_refined);
    return proposals;
  }

  // The part of the model that faces the eye, thinned to about `most` points.
  Cloud::Ptr Facing(const Proposal& proposal, const Eigen::Vector3d& eye, std::size_t most) const {
    const ObjectModel& model = *models_[proposal.model].model;
    const std::vector<int> facing = rimod::peers::FacingPoints(model, proposal.T_scan_model, eye);
    const std::size_t step = std::max<std::size_t>(1, facing.size() / most);
    std::vector<Eigen::Vector3f> points;
    for (std::size_t i = 0; i < facing.size(); i += step)
      points.push_back(model.points[static_cast<std::size_t>(facing[i])]);
    return rimod::peers::CloudOf(points);
  }

  void Refine(const Eigen::Vector3d& eye, const Cloud::Ptr& surface,
              const pcl::search::KdTree<pcl::PointXYZ>::Ptr& tree, Proposal* proposal) const {
    constexpr std::size_t kPoints = 400, kFewest = 20;
    const Cloud::Ptr facing = Facing(*proposal, eye, kPoints);
    if (settings_.icp_iterations == 0 || facing->size() < kFewest) return;
    pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
    icp.setMaximumIterations(settings_.icp_iterations);
    icp.setMaxCorrespondenceDistance(settings_.icp_reach);
    icp.setInputTarget(surface);
    icp.setSearchMethodTarget(tree, true);
    icp.setInputSource(facing);
    Cloud aligned;
    icp.align(aligned, proposal->T_scan_model.matrix().cast<float>());
    const Eigen::Isometry3d T = rimod::peers::PoseOf(icp.getFinalTransformation().cast<double>());
    if (icp.hasConverged() && rimod::peers::IsUpright(T)) proposal->T_scan_model = T;
  }

  // Gives up what is not in the best set of poses, and what is beyond max_verified of a model.
  void Verify(const Eigen::Vector3d& eye, const Cloud::Ptr& surface,
              std::vector<Proposal>* proposals) const {
    constexpr std::size_t kPoints = 2000;
    std::vector<std::size_t> verified, count(models_.size(), 0);
    std::vector<Cloud::ConstPtr> visible, whole;
    for (std::size_t i = 0; i < proposals->size(); ++i) {
      Proposal& proposal = (*proposals)[i];
      if (++count[proposal.model] > settings_.max_verified) continue;
      const Eigen::Matrix4f T = proposal.T_scan_model.matrix().cast<float>();
      const Cloud::Ptr facing(new Cloud), complete(new Cloud);
      pcl::transformPointCloud(*Facing(proposal, eye, kPoints), *facing, T);
      pcl::transformPointCloud(*rimod::peers::CloudOf(models_[proposal.model].model->points),
                               *complete, T);
      visible.push_back(facing);
      whole.push_back(complete);
      verified.push_back(i);
    }
    std::vector<bool> right(verified.size(), false);
    if (!verified.empty()) {
      pcl::GlobalHypothesesVerification<pcl::PointXYZ, pcl::PointXYZ> verification;
      verification.setResolution(static_cast<float>(settings_.shot.surface_spacing));
      verification.setSceneCloud(surface);
      verification.addModels(visible, false);
      verification.addCompleteModels(whole);
      verification.setInlierThreshold(static_cast<float>(settings_.inlier_distance));
      verification.setRegularizer(static_cast<float>(settings_.regularizer));
      verification.setRadiusClutter(0.1f);
      verification.setClutterRegularizer(static_cast<float>(settings_.clutter_regularizer));
      verification.setDetectClutter(true);
      verification.setMaxIterations(settings_.verify_iterations);
      verification.setRadiusNormals(static_cast<float>(settings_.shot.normal_radius));
      verification.verify();
      verification.getMask(right);
    }
    std::vector<double> measures(proposals->size(), -1.0);
    for (std::size_t k = 0; k < verified.size(); ++k)
      if (right[k]) measures[verified[k]] = (*proposals)[verified[k]].measure;
    for (std::size_t i = 0; i < proposals->size(); ++i) (*proposals)[i].measure = measures[i];
  }

  Settings settings_;
  int num_threads_ = 1;
  rimod::Execution execution_;
  std::vector<Model> models_;
};

}  // namespace

int main(int argc, char** argv) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // else a line for each failed group
  Pipeline pipeline;
  return rimod::peers::RunPeer(argc, argv, &pipeline);
}
